"""The best score so far of each exercise, from the JSON reports below the folder of runs.

`course grade` leaves the report of its best grading beside its recordings (`keep_best`) when it grades into its default
folder; `course list` reads them all (`best_scores`). Anybody may have put anything into that folder, so what is no
report of today's exercise is passed over.
"""

from __future__ import annotations

import json
import math
import os
import stat
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.grader.errors import UsageError

if TYPE_CHECKING:
    from gz_course.grader.report.report import Report

RUNS = Path("runs")  # where `course grade` puts its folders unless told otherwise
BEST = "best.json"
MOST_BYTES = 4 << 20  # of a report; real ones have some 10 KB
MOST_POINTS = 1e9  # whatever claims more is no report


@dataclass
class BestScores:
    """The highest score by exercise; `stale` names those with reports of another maximum than today's."""

    scores: dict[str, float] = field(default_factory=dict)
    stale: set[str] = field(default_factory=set)

    def add(self, path: Path, most: Mapping[str, float]) -> None:
        """Count the report in a file, if it is one of an exercise in `most`, which maps them to today's maximum."""
        report = _read(path)
        name, score, maximum = report.get("exercise"), _points(report.get("score")), _points(report.get("max_score"))
        if not isinstance(name, str) or name not in most:
            return
        if score is None or maximum is None or score > maximum:
            return
        if math.isclose(maximum, most[name]):
            self.scores[name] = max(score, self.scores.get(name, 0.0))
        else:
            self.stale.add(name)


def best_scores(folder: Path, most: Mapping[str, float]) -> BestScores:
    """Return the best scores in the reports below `folder`; `most` is the maximum of each exercise today.

    Files that are no such report, cannot be read, or claim more than their own maximum are passed over.
    """
    best = BestScores()
    for path in _files_below(folder):
        best.add(path, most)
    return best


def keep_best(report: Report, folder: Path) -> None:
    """Write the report to `best.json` in `folder`, unless a better one stands there. Raises UsageError if it cannot."""
    path = folder / BEST
    before = BestScores()
    before.add(path, {report.exercise: report.max_score})
    if report.score.points < before.scores.get(report.exercise, 0.0):
        return
    part = path.with_name(f"{BEST}.{os.getpid()}.part")
    try:
        part.write_text(report.as_json(), encoding="utf-8")
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise UsageError(f"cannot write {path}: {error.strerror}") from None


def _files_below(folder: Path) -> Iterator[Path]:
    """Return the JSON files below a folder, in no order; symbolic links to folders are not followed."""
    for base, _, names in os.walk(folder):
        yield from (Path(base, name) for name in names if name.endswith(".json"))


def _read(path: Path) -> dict[str, Any]:
    """Return the JSON object a file holds; an empty one if it is no file or holds something else."""
    try:
        about = path.stat()
        if not stat.S_ISREG(about.st_mode) or about.st_size > MOST_BYTES:  # a pipe would never end
            return {}
        report = json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError):
        return {}
    return report if isinstance(report, dict) else {}


def _points(value: Any) -> float | None:
    """Return a value that can be a number of points, else None."""
    possible = isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value <= MOST_POINTS
    return float(value) if possible else None
