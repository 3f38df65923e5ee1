"""The best score so far in each exercise, from the JSON reports below the folder of runs.

`course grade` leaves the report of its best grading beside its recordings (`keep_best`) when it grades into its default
folder; `course list` reads them all (`best_scores`). Files that are not reports of the present exercise are ignored.
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
from gz_course.grader.exercise import course_root
from gz_course.grader.process.whole_file import write_whole

if TYPE_CHECKING:
    from gz_course.grader.report.report import Report

BEST = "best.json"
MOST_BYTES = 4 << 20  # of a report; real ones have some 10 KB
MOST_POINTS = 1e9  # a file that claims more is not a report


def runs_folder() -> Path:
    """Return the default folder of `course grade`: COURSE_RUNS, else `runs` beside the exercises, wherever one stands.

    It is relative to the current folder if that lies in the course.
    """
    if given := os.environ.get("COURSE_RUNS"):
        return Path(given)
    root, here = course_root().resolve(), Path.cwd()
    return Path(os.path.relpath(root, here), "runs") if here.is_relative_to(root) else root / "runs"


@dataclass
class BestScores:
    """The highest score by exercise; `stale` names those whose reports have another maximum than the present one."""

    scores: dict[str, float] = field(default_factory=dict)
    stale: set[str] = field(default_factory=set)

    def add(self, path: Path, most: Mapping[str, float]) -> None:
        """Count the report in a file if its exercise is in `most`, the present maximum by exercise."""
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
    """Return the best scores in the reports below `folder`; `most` is the present maximum of each exercise.

    Files that are not such reports, cannot be read, or claim more than their own maximum are ignored.
    """
    best = BestScores()
    for path in _files_below(folder):
        best.add(path, most)
    return best


def keep_best(report: Report, folder: Path) -> None:
    """Write the report to `best.json` in `folder` unless a better one is there. Raises UsageError if it cannot."""
    path = folder / BEST
    before = BestScores()
    before.add(path, {report.exercise: report.max_score})
    if report.score.points < before.scores.get(report.exercise, 0.0):
        return
    try:
        write_whole(path, report.as_json().encode())
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror}") from None


def _files_below(folder: Path) -> Iterator[Path]:
    """Return the JSON files below a folder, in no particular order; symbolic links to folders are not followed."""
    for base, _, names in os.walk(folder):
        yield from (Path(base, name) for name in names if name.endswith(".json"))


def _read(path: Path) -> dict[str, Any]:
    """Return the JSON object in a file; an empty one if the file holds anything else."""
    try:
        about = path.stat()
        if not stat.S_ISREG(about.st_mode) or about.st_size > MOST_BYTES:  # reading a pipe might never end
            return {}
        report = json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError):
        return {}
    return report if isinstance(report, dict) else {}


def _points(value: Any) -> float | None:
    """Return a value that can be a number of points, else None."""
    possible = isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value <= MOST_POINTS
    return float(value) if possible else None
