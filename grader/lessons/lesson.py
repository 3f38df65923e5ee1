"""The questions of a chapter: predictions, and questions that come back two chapters later.

They stand in `grading/lesson.toml` of the chapter's exercise, the steps in `grading/steps.py`:

    [predict.stands]              # room.predict("stands") in the notebook
    objective = 1
    choices = ["0.6 m ahead", "where it was", "somewhere else"]
    answer = 2                    # none: it differs from machine to machine
    why = "The bridge listens on /cmd_vel, so no message reached the robot."

    [[review]]                    # room.review("03_teleop")
    objective = 2
    question = "Which field of a Twist turns the robot?"
    choices = ["angular.x", "angular.z", "linear.y"]
    answer = 2
    why = "A turn about the upward axis, z."

    [graded]                      # objective -> the checks of the exercise that grade it
    1 = ["drives"]
    2 = ["07_frames:ahead"]       # a check of a later exercise
    3 = ["cell:circle"]           # a cell to write, whose check is the only one

A prediction without choices is a line of text.
"""

from __future__ import annotations

import ast
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.exercise.grading import grading_folder, grading_module
from gz_course.grader.lessons.step import Step, steps_of
from gz_course.sim.did_you_mean import did_you_mean

LESSON, STEPS = "lesson.toml", "steps"
Named = TypeVar("Named")


@dataclass(frozen=True)
class Question:
    """A prediction or a question of review; `answer` is the number of the right choice, from 1, 0 for none."""

    name: str
    objective: int
    choices: tuple[str, ...]
    answer: int
    why: str
    question: str = ""

    @property
    def right(self) -> str:
        """The right choice in words; empty if there is none."""
        return self.choices[self.answer - 1] if self.answer else ""

    def said(self, choice: int | str) -> str:
        """Return a choice in words. Raises UsageError for a number that is none."""
        if isinstance(choice, str):
            return choice.strip()
        if isinstance(choice, bool) or not isinstance(choice, int) or not 1 <= choice <= len(self.choices):
            numbers = f"a number from 1 to {len(self.choices)}" if self.choices else "a line of text in quotes"
            raise UsageError(f"{choice!r} is no answer; give {numbers}")
        return self.choices[choice - 1]


@dataclass(frozen=True)
class Lesson:
    """What a chapter asks."""

    chapter: str
    steps: dict[str, Step]
    predictions: dict[str, Question]
    review: tuple[Question, ...] = ()
    graded: dict[int, tuple[str, ...]] = field(default_factory=dict)

    def step(self, name: str) -> Step:
        """Return a step. Raises UsageError, with the nearest name, if there is none."""
        return _named(name, self.steps, f"chapter {self.chapter} has no step")

    def prediction(self, name: str) -> Question:
        """Return a prediction. Raises UsageError, with the nearest name, if there is none."""
        return _named(name, self.predictions, f"chapter {self.chapter} has no prediction")


def load_lesson(exercise: Path) -> Lesson:
    """Read the lesson of the exercise in this folder; an exercise without one has an empty lesson.

    Raises ManifestError if its file cannot be read.
    """
    grading = grading_folder(exercise)
    if grading is None:
        return Lesson(exercise.name, {}, {})
    steps = steps_of(grading_module(grading, STEPS)) if (grading / f"{STEPS}.py").is_file() else {}
    path = grading / LESSON
    if not path.is_file():
        return Lesson(exercise.name, steps, {})
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
        predictions = {name: _question(name, each) for name, each in table.get("predict", {}).items()}
        review = tuple(_question(f"review {n}", each) for n, each in enumerate(table.get("review", []), start=1))
        graded = {int(number): tuple(map(str, checks)) for number, checks in table.get("graded", {}).items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise ManifestError(f"{path}: {error}") from None
    return Lesson(exercise.name, steps, predictions, review, graded)


def number_of_steps(grading: Path) -> int:
    """Return how many steps the chapter of the exercise has that this folder grades, without importing them."""
    try:
        tree = ast.parse((grading / f"{STEPS}.py").read_bytes())
    except (OSError, SyntaxError):
        return 0
    calls = (each for node in tree.body if isinstance(node, ast.FunctionDef) for each in node.decorator_list)
    return sum(isinstance(each, ast.Call) and getattr(each.func, "id", "") == "step" for each in calls)


def _question(name: str, table: dict[str, object]) -> Question:
    unknown = set(table) - {"objective", "choices", "answer", "why", "question"}
    if unknown:
        raise ValueError(f"{name} has a key {min(unknown)!r}, which no question has")
    choices, answer, objective = table.get("choices", []), table.get("answer", 0), table["objective"]
    if not isinstance(choices, list) or not isinstance(answer, int) or not isinstance(objective, int):
        raise ValueError(f"{name}: choices is a list of texts, answer and objective are numbers")
    if not 0 <= answer <= len(choices):
        raise ValueError(f"{name}: answer is {answer}, but there are {len(choices)} choices")
    return Question(
        name, objective, tuple(map(str, choices)), answer, str(table["why"]), str(table.get("question", ""))
    )


def _named(name: str, named: dict[str, Named], missing: str) -> Named:
    if name not in named:
        raise UsageError(f"{missing} {name!r}{did_you_mean(name, list(named), listing='known')}")
    return named[name]
