"""The map of the course: where each objective is practised, asked and graded, and what proves each check.

Generated from the notebooks, the lessons, the manifests and the instructor's half.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import CheckSpec, Exercise, find_exercise
from gz_course.grader.lessons.lesson import load_lesson
from gz_course.grader.tools.book.chapter import Chapter, chapters
from gz_course.grader.verify import variants


@dataclass(frozen=True)
class Proven:
    """A check and the names of the rejected variants that must fail it."""

    check: CheckSpec
    rejected: tuple[str, ...]


@dataclass(frozen=True)
class Objective:
    """What the reader can do afterwards: the cells to write, the questions, and the checks that are about it.

    A check of another exercise than the chapter's is `EXERCISE: TITLE`; where a cell's own check is all that grades an
    objective, it is `cell NAME`.
    """

    text: str
    practised: tuple[str, ...]
    asked: tuple[str, ...]
    graded: tuple[str, ...]


@dataclass(frozen=True)
class Lesson:
    """A chapter with its exercise. `proven` is empty in a students' copy, which has no rejected variants."""

    chapter: Chapter
    exercise: Exercise
    objectives: tuple[Objective, ...]
    proven: tuple[Proven, ...]


def lessons(root: Path) -> list[Lesson]:
    """Return all lessons of a course folder in order. Raises CourseError for a chapter without its exercise."""
    return [_lesson(root, chapter) for chapter in chapters(root)]


def _lesson(root: Path, chapter: Chapter) -> Lesson:
    exercise = find_exercise(chapter.name, root)
    about = tuple(_objectives(root, chapter, exercise))
    if not exercise.twin.is_dir():
        return Lesson(chapter, exercise, about, ())
    rejected = [each for each in variants(exercise) if each.name.startswith("rejected/")]
    proven = [
        Proven(check, tuple(each.name.partition("/")[2] for each in rejected if check.id in each.fails))
        for check in exercise.checks
    ]
    return Lesson(chapter, exercise, about, tuple(proven))


def _objectives(root: Path, chapter: Chapter, exercise: Exercise) -> Iterator[Objective]:
    lesson = load_lesson(exercise.folder)
    for number, text in enumerate(chapter.objectives, start=1):
        cells = tuple(name for name, step in lesson.steps.items() if step.objective == number)
        asked = [name for name, question in lesson.predictions.items() if question.objective == number]
        asked += [question.name for question in lesson.review if question.objective == number]
        graded = tuple(_graded(root, exercise, each, cells) for each in lesson.graded.get(number, ()))
        yield Objective(text, cells, tuple(asked), graded)


def _graded(root: Path, exercise: Exercise, name: str, cells: tuple[str, ...]) -> str:
    """Return a check in words: its title, after the name of its exercise if that is another one, or `cell NAME`.

    Raises ManifestError if there is none of that name, or if the cell does not practise the objective.
    """
    other, colon, id = name.rpartition(":")
    if other == "cell" and id in cells:
        return f"cell {id}"
    where = find_exercise(other, root) if colon and other != "cell" else exercise
    titles = {check.id: check.title for check in where.checks}
    if other == "cell" or id not in titles:
        raise ManifestError(f"{exercise.grading}: [graded] names {name!r}, which is no check")
    return f"{where.name}: {titles[id]}" if colon else titles[id]
