"""The search for the smallest change that helps: single edits in the likeliest order, then pairs.

A change helps if it passes a further check and loses none. The search ends with full marks, and a few trials later, in
which another place could be found that would do; or when the budget is spent.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

from gz_course.grader.edits import Edit, edits_of
from gz_course.grader.edits.edit import both
from gz_course.grader.errors import InfrastructureError
from gz_course.grader.exercise import Exercise
from gz_course.grader.explain.order import ordered
from gz_course.grader.explain.task import vocabulary, words_of
from gz_course.grader.explain.trials import Files, Outcome, Trials

MORE = 6  # trials after the first change that earns full marks
ENOUGH = 2  # places that are named
MOST_PAIRED = 12  # edits of which pairs are tried


@dataclass(frozen=True)
class Change:
    """One edit, or two that are needed together, and what the program with it earned."""

    edits: tuple[Edit, ...]
    outcome: Outcome

    @property
    def lines(self) -> list[tuple[str, int]]:
        """Files and lines of the edits."""
        return [(each.file, each.line) for each in self.edits]


@dataclass
class Found:
    """What a search found: changes that help, the best first; `nearest` passed a further check, but lost another."""

    before: Outcome
    edits: int  # that there are
    trials: int = 0
    changes: list[Change] = field(default_factory=list)
    nearest: Change | None = None

    @property
    def full_marks(self) -> bool:
        """Whether a change earns all points, or none is needed."""
        return not (self.changes[0].outcome if self.changes else self.before).failed


def search(
    exercise: Exercise, files: Files, main: str, trials: Trials, told: Callable[[Edit], None]
) -> Iterator[Found]:
    """Yield what is found, at first and after each trial; `told` hears of each edit that is tried.

    `files` are those of the submission, `main` among them. Raises InfrastructureError if it cannot be graded.
    """
    before = trials.grade(files, explained=True)
    if before is None:
        raise InfrastructureError("this machine could not grade the submission; try again")
    edits = _edits(exercise, files, main, before) if before.failed else []
    found = Found(before, len(edits))
    yield found
    moved: list[Edit] = []  # that changed what a failed check measured

    def versions(chosen: Sequence[tuple[Edit, ...]]) -> Iterator[Files]:
        for each in chosen:
            told(each[0])
            yield files | edited(files, each)

    if found.full_marks:
        return
    last = None
    singles = [(each,) for each in edits]
    for number, outcome in trials.run(versions(singles)):
        found.trials += 1
        if outcome is not None:
            _judge(found, Change(singles[number], outcome))
            if outcome.passed == before.passed and outcome.failed != before.failed:
                moved.append(edits[number])
        yield found
        if last is None and found.full_marks:
            last = found.trials + MORE
        if last is not None and (found.trials >= last or len(_places(found)) >= ENOUGH):
            return
    if found.full_marks:
        return
    helps = [change.edits[0] for change in found.changes]
    pairs = [
        pair
        for pair in itertools.combinations([*helps, *moved][:MOST_PAIRED], 2)
        if pair[0].file != pair[1].file or both(files[pair[0].file], *pair) is not None
    ]
    for number, outcome in trials.run(versions(pairs)):
        found.trials += 1
        if outcome is not None:
            _judge(found, Change(pairs[number], outcome))
        yield found
        if found.full_marks:
            return


def _edits(exercise: Exercise, files: Files, main: str, before: Outcome) -> list[Edit]:
    known = vocabulary(exercise, before.failed)
    names = [main, *(each for each in exercise.files if each in files)]
    edits = [edit for name in names for edit in edits_of(name, files[name], known)]
    passed = [each for each in before.checks if each["status"] == "passed"]
    return ordered(edits, files, before.said, words_of(exercise, before.failed), words_of(exercise, passed))


def edited(files: Files, edits: tuple[Edit, ...]) -> Files:
    """Return the files that one edit, or two, have changed."""
    if len(edits) == 2 and edits[0].file == edits[1].file:
        content = both(files[edits[0].file], *edits)
        assert content is not None
        return {edits[0].file: content}
    return {each.file: each.content for each in edits}


def _judge(found: Found, change: Change) -> None:
    """Keep a change that helps; of those of one line the best."""
    before, now = found.before, change.outcome
    if now.passed > before.passed:
        same = next((each for each in found.changes if each.lines == change.lines), None)
        if same is None or same.outcome.points < now.points:
            found.changes = [each for each in found.changes if each is not same] + [change]
        found.changes.sort(key=lambda each: (-each.outcome.points, len(each.edits)))
    elif now.passed - before.passed and (found.nearest is None or now.points > found.nearest.outcome.points):
        found.nearest = change


def _places(found: Found) -> list[Change]:
    """Return the changes that earn full marks."""
    return [each for each in found.changes if not each.outcome.failed]
