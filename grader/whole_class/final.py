"""The results that count: those of the gradings, less what lateness costs, with what was changed by hand.

The journal keeps the results of the gradings; these are made anew from them whenever gradebook and page are written.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import datetime
from pathlib import Path
from types import MappingProxyType
from typing import Any

from markupsafe import escape

from gz_course.grader.exercise import Exercise
from gz_course.grader.process.whole_file import write_whole
from gz_course.grader.report.format import formats
from gz_course.grader.whole_class.attempts import UNGRADED, counted
from gz_course.grader.whole_class.grading import REPORT
from gz_course.grader.whole_class.late_policy import LAST, LatePolicy, read_policy
from gz_course.grader.whole_class.overrides import Override, read_overrides

EXCUSED = "excused"
BY_HAND = "by_hand"  # key of a report in JSON
NOTE = re.compile(r'<p class="note" id="by-hand"[^>]*>.*?</p>', re.DOTALL)  # of a page

Result = dict[str, Any]


class Final:
    """The rules of a class, read and checked: raises UsageError before anything is graded or written."""

    def __init__(self, exercise: Exercise, folder: Path, students: Iterable[tuple[str, str]]) -> None:
        """Read `class.toml` and `overrides.csv`; `students` are names and ids."""
        self._exercise = exercise
        self._policy = read_policy(folder)
        self._overrides = read_overrides(folder, exercise, dict(students))

    @property
    def attempts(self) -> str:
        """Which attempts count: `best`, `last` or `mean`; empty if earlier ones are not kept."""
        return self._policy.attempts if self._policy is not None else ""

    def results(
        self, graded: Sequence[Result], earlier: Mapping[str, Sequence[Result]] = MappingProxyType({})
    ) -> list[Result]:
        """Return what counts of each result: it has `machine_score`, and `changes` in words.

        `earlier` are the results of earlier attempts by student.
        """
        return [self._result(each, earlier.get(each["student"], ())) for each in graded]

    def _result(self, last: Result, earlier: Sequence[Result]) -> Result:
        own = [each for each in self._overrides if each.student == last["student"]]
        tries = [*earlier, last] if self.attempts else [last]
        scored = [self._scored(each, own) for each in tries]
        counts, told = counted(self.attempts or LAST, scored)
        changes = [*counts["changes"], *told]
        if last.get(UNGRADED):
            changes.append("an earlier attempt could not be graded yet")
        score, outcome, points = counts["score"], counts["outcome"], counts["points"]
        for each in own:
            if not each.check and each.points is not None:
                before = "no grade" if score is None else f"{score:g}"
                changes.append(f"total {before} -> {each.points:g}{_why(each)}")
                score = each.points
            elif each.excused:
                changes.append(f"excused{_why(each)}")
                score, outcome, points = None, EXCUSED, {}
            elif not each.check and each.comment:
                changes.append(each.comment)
        more = {"changes": changes, "score": score, "points": points, "outcome": outcome, "attempts": len(tries)}
        return counts | more

    def _scored(self, graded: Result, own: Sequence[Override]) -> Result:
        """Return an attempt with the points of checks that were changed by hand, less what lateness costs."""
        points, changes = dict(graded["points"]), list[str]()
        for each in own:
            if each.check and each.points is not None:
                changes.append(f"{each.check} {points.get(each.check, 0):g} -> {each.points:g}{_why(each)}")
                points[each.check] = each.points
        score = graded["score"]
        if changes:
            score = round(sum(points.values()), 6)
        if score is not None and self._policy is not None:
            score = self._late(self._policy, graded, score, own, changes)
        return graded | {"machine_score": graded["score"], "changes": changes, "score": score, "points": points}

    def _late(
        self, policy: LatePolicy, graded: Result, score: float, own: Sequence[Override], changes: list[str]
    ) -> float:
        extended = next((each for each in own if each.deadline is not None), None)
        submitted = datetime.fromisoformat(text) if (text := graded.get("submitted")) else None
        due = extended.deadline if extended is not None else None
        off, why = policy.taken_off(submitted, self._exercise.max_score, due)
        if not off or not score:
            return score
        left = max(0.0, round(score - off, 6))
        changes.append(f"{score:g} -> {left:g} ({why})")
        return left


def names_and_ids(results: Iterable[Result]) -> Iterator[tuple[str, str]]:
    """Yield the names of students, with their ids."""
    yield from ((each["student"], each["id"]) for each in results)


def tell_students(out: Path, final: Iterable[Result]) -> None:
    """Say in the reports of students what was changed; take it out of those in which nothing is changed any more.

    Their pages say, too, which files were taken under other names. Raises OSError if a report cannot be written.
    """
    for result in final:
        told = result["changes"]
        report = out / result["folder"] / REPORT
        if not report.is_file():
            continue
        data = report.read_bytes()
        if not told and not result.get("notes") and BY_HAND.encode() not in data:
            continue
        content = json.loads(data)
        content.pop(BY_HAND, None)
        if told:
            content[BY_HAND] = {"score": result["score"], "changes": told}
        if (text := (json.dumps(content, indent=2) + "\n").encode()) != data:
            write_whole(report, text)
        page = out / result["folder"] / formats()["html"].file
        if page.is_file() and (marked := _marked(old := page.read_text(encoding="utf-8"), result)) != old:
            write_whole(page, marked.encode())


def _marked(page: str, result: Result) -> str:
    """Return a page with the note of what was changed, instead of an earlier one."""
    score = "no grade" if result["score"] is None else f"{result['score']:g} points"
    said = [*result.get("notes", ())]
    if result["changes"]:
        said.append(f"Your grade: {score}. {'; '.join(result['changes'])}.")
    note = f">{escape(' '.join(said))}" if said else " hidden>"
    return NOTE.sub(lambda _: f'<p class="note" id="by-hand"{note}</p>', page, count=1)


def _why(override: Override) -> str:
    said = ": ".join(filter(None, (f"by {override.by}" if override.by else "", override.comment)))
    return f" ({said})" if said else ""
