"""What a notebook of the course can do: `%%step` for cells to write, `room.predict`, `room.review` and
`room.stuck`.

A playground puts it in force in the notebook's kernel. The chapter is the folder that the kernel runs in.
"""

from __future__ import annotations

import functools
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.lessons.attempt import attempt
from gz_course.grader.lessons.kept import PREDICTIONS, STEPS, Kept
from gz_course.grader.lessons.lesson import Lesson, Question, load_lesson
from gz_course.grader.lessons.questions import Ask, beside, judged
from gz_course.grader.lessons.stuck import Stuck

if TYPE_CHECKING:
    from gz_course.grader.tools.playground import Playground

MAGIC = "step"


class Classroom:
    """The lesson of one chapter in a notebook; `begin` puts it in force."""

    def __init__(self, room: Playground, folder: Path) -> None:
        self._room, self.folder = room, folder
        self._kept = Kept(folder)
        self._pending: Question | None = None
        self._asked = False  # in the cell that runs

    @functools.cached_property
    def lesson(self) -> Lesson:
        """What this chapter asks."""
        return load_lesson(self.folder.parents[1] / "exercises" / self.folder.name)

    def begin(self) -> None:
        """Register the magic and the look at each cell's end, if this is a notebook; a later one takes its place."""
        shell = _shell()
        if shell is None:
            return
        shell.register_magic_function(self.step, "cell", MAGIC)
        for before in [each for each in shell.events.callbacks["post_run_cell"] if _is_ours(each)]:
            shell.events.unregister("post_run_cell", before)
        shell.events.register("post_run_cell", self.after_cell)

    def step(self, line: str, cell: str) -> None:
        """Run a cell that its reader writes, and say what was seen: `%%step NAME`."""
        shell = _shell()
        try:
            step = self.lesson.step(line.strip())
        except (UsageError, ManifestError) as error:
            print(error)
            return
        answer = attempt(step, cell, shell.user_ns, self._room, self.folder, shell.transform_cell)
        self._kept.keep(STEPS, step.name, answer.done)
        print(answer)

    def predict(self, name: str, choice: int | str | None = None) -> Ask:
        """Ask for a prediction, or keep the one given; the next cell sets it beside its outcome."""
        question = self.lesson.prediction(name)

        def keep(said: str) -> str:
            self._kept.keep(PREDICTIONS, name, said)
            return "Kept. Now run the next cell."

        if choice is not None:
            keep(question.said(choice))
        self._pending, self._asked = question, True
        return Ask(question, f'room.predict("{name}", {{}})', self._kept.prediction(name), keep)

    def review(self, chapter: str, number: int = 0, choice: int | str | None = None) -> Any:
        """Ask the questions of a chapter again, or answer one of them."""
        lesson = load_lesson(self.folder.parents[1] / "exercises" / chapter)
        if not lesson.review:
            print(f"There are no questions about {chapter}.")
            return None
        if choice is not None:
            if not 1 <= number <= len(lesson.review):
                raise UsageError(f"question {number} is none of 1 to {len(lesson.review)}")
            question = lesson.review[number - 1]
            print(judged(question, question.said(choice)))
            return None
        asked = [
            Ask(each, f'room.review("{chapter}", {n}, {{}})', None, functools.partial(judged, each))
            for n, each in enumerate(lesson.review, start=1)
        ]
        if _shell() is None:
            return asked
        for each in asked:
            each._ipython_display_()
        return None

    def stuck(self) -> Stuck:
        """Offer the help that there is on this chapter's exercise."""
        return Stuck(self.folder.name, self.folder)

    def after_cell(self, _result: Any = None) -> None:
        """Set a prediction beside the outcome, at the end of the cell after it."""
        if self._asked:
            self._asked = False
        elif self._pending is not None:
            question, self._pending = self._pending, None
            print("\n" + beside(question, self._kept.prediction(question.name)))


def _is_ours(callback: Any) -> bool:
    return isinstance(getattr(callback, "__self__", None), Classroom)


def _shell() -> Any:
    """Return the notebook's IPython; None in a plain program."""
    if "IPython" not in sys.modules:
        return None
    from IPython import get_ipython

    return get_ipython()
