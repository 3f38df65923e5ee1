"""An explanation: a submission is read, graded, and searched for the change that helps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.exercise import Exercise
from gz_course.grader.explain.search import Found, search
from gz_course.grader.explain.sentence import sentences
from gz_course.grader.explain.trials import Files, Trials
from gz_course.grader.submission.intake import take_in
from gz_course.grader.submission.untouched import untouched

FULL_MARKS = "Full marks: there is nothing to explain."


@dataclass(frozen=True)
class Explanation:
    """What is said, and whether a change with full marks was found. `found` is None if nothing could be tried."""

    sentences: tuple[str, ...]
    found: Found | None
    solved: bool
    spent: float  # [s] of processor time
    interrupted: bool = False
    files: Files = field(default_factory=dict, repr=False)  # of the submission


def explain(
    exercise: Exercise,
    submission: Path | None,
    budget: float,
    sandbox: str = "auto",
    kept: Path | None = None,
    told: Callable[[str, float], None] = lambda text, spent: None,
) -> Explanation:
    """Search for the change of a submission that helps, with `budget` [s] of processor time.

    Call within `gradings_end_here()`. `kept` is the file that keeps outcomes for the next search; `told` hears what is
    tried and what is spent. Ctrl-C ends the search, and what was found is returned. Raises UsageError if there is
    nothing to read, InfrastructureError if it cannot be graded.
    """
    given = take_in(exercise, submission)
    if first := given.fault or untouched(exercise, given.main, given.files):
        return Explanation((first,), None, False, 0.0)
    trials = Trials(exercise, given.main, budget, sandbox, kept)
    return explain_files(exercise, given.files, given.main, trials, told)


def explain_files(
    exercise: Exercise, files: Files, main: str, trials: Trials, told: Callable[[str, float], None]
) -> Explanation:
    """Search as `explain` does, for files that have been read; raises InfrastructureError as it does."""
    found: Found | None = None
    interrupted = False
    steps = search(exercise, files, main, trials, lambda edit: told(f"{edit.file}, line {edit.line}", trials.spent))
    try:
        while (step := next(steps, None)) is not None:
            found = step
    except KeyboardInterrupt:
        interrupted = True
    finally:
        trials.keep()
    if found is None:
        raise InfrastructureError("the search was interrupted before its first trial")
    if not found.before.failed:
        return Explanation((FULL_MARKS,), found, True, trials.spent, interrupted, files)
    lines = sentences(found, files, exercise.max_score, shown=exercise.shows_change)
    return Explanation(tuple(lines), found, found.full_marks, trials.spent, interrupted, files)
