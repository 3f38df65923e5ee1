"""Reports of a verification that is not finished, kept so that the same command goes on after an interruption.

Each grading leaves its report in a file as soon as it has one. The name of the file is a digest of all that decides it:
the exercise, what is submitted, the trials, where the recordings go, and the code of the course. A finished proof
removes them: what is proved is always graded anew.
"""

from __future__ import annotations

import contextlib
import hashlib
import pickle
import shutil
from pathlib import Path

from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.bundle import bundle, digest
from gz_course.grader.process.code_stamp import code_stamp
from gz_course.grader.process.whole_file import write_whole
from gz_course.grader.report.best import runs_folder
from gz_course.grader.report.report import Report
from gz_course.grader.whole_class.versions import versions

FOLDER = "verify"  # below the folder of runs


class Kept:
    """The reports of one exercise so far. `out` is the folder that the recordings stay in, if they do."""

    def __init__(self, exercise: Exercise, out: Path | None) -> None:
        self.folder = runs_folder() / FOLDER / exercise.name
        files, _ = bundle(exercise, "all")
        place = "" if out is None else str(out.resolve())
        self._begin = f"{digest(files)} {versions()} {code_stamp()} {place}"

    def place(self, submitted: dict[str, bytes], trials: object) -> Path:
        """Return the file for the report on what is submitted, in these trials."""
        told = f"{self._begin} {digest(submitted)} {trials!r}"
        return self.folder / f"{hashlib.sha256(told.encode()).hexdigest()}.report"

    def forget(self) -> None:
        """Remove all reports: the proof is complete."""
        shutil.rmtree(self.folder, ignore_errors=True)


def read(place: Path) -> Report | None:
    """Return the report that an earlier command left; None if there is none that can be read."""
    try:
        report = pickle.loads(place.read_bytes())
    except Exception:  # absent, torn, or of another version
        return None
    return report if isinstance(report, Report) else None


def write(place: Path, report: Report) -> None:
    """Leave a report; if the disk does not take it, it is graded again."""
    with contextlib.suppress(OSError):
        place.parent.mkdir(parents=True, exist_ok=True)
        write_whole(place, pickle.dumps(report))
