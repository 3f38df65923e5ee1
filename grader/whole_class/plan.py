"""What grading a class will take: gradings, time and disk, estimated from what earlier gradings have measured."""

from __future__ import annotations

import json
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean
from typing import Any

from gz_course.grader.whole_class.grading import REPORT
from gz_course.grader.whole_class.journal import Results
from gz_course.grader.whole_class.kept import is_kept, readable_size, recordings_on_disk

LOOKED_AT = 50  # reports of earlier gradings


@dataclass(frozen=True)
class Measured:
    """Means of earlier gradings: wall time of one [s]; recordings of one student [bytes]; how many are kept."""

    seconds: float
    size: float
    kept: float


@dataclass(frozen=True)
class Plan:
    """A class before it is graded. `done` submissions have results in the journal, which has `damaged` lines.

    `at_once` is None on Dask, where the number of workers is not known before.
    """

    submissions: int
    done: int
    trials: int
    at_once: int | None
    keep: str
    measured: Measured | None
    free: int
    damaged: int = 0

    @property
    def left(self) -> int:
        return self.submissions - self.done

    def lines(self) -> list[str]:
        """Return the plan as sentences."""
        trials = "1 trial" if self.trials == 1 else f"{self.trials} trials"
        at_once = "one for each thread of Dask's workers" if self.at_once is None else str(self.at_once)
        text = f"{self.submissions} submissions, {trials} each, {at_once} at a time"
        told = [text + (f"; {self.done} are done" if self.done else "")]
        if self.damaged:
            lines = "1 line of the journal is" if self.damaged == 1 else f"{self.damaged} lines of the journal are"
            told.append(f"{lines} damaged or cut off; what is missing is graded again")
        if not self.left:
            return told
        if self.measured is None:
            return [*told, f"time and disk are estimated after the first gradings; {readable_size(self.free)} are free"]
        one = self.measured
        text = readable_time(self.left * one.seconds / (self.at_once or 1))
        told.append(f"about {text} for {self.left} gradings{'' if self.at_once else ' on one worker'}")
        size = self.left * one.kept * one.size
        if size:
            each, free = readable_size(one.size), readable_size(self.free)
            told.append(f"recordings (--keep {self.keep}): about {readable_size(size)}, {each} each; {free} are free")
        if size > self.free:
            told.append("that is more than there is: give --keep failing or --keep none, or --out on a larger disk")
        return told


def make_plan(
    out: Path, journal: Results, submissions: int, done: int, *, trials: int, at_once: int | None, keep: str,
    most: float,
) -> Plan:  # fmt: skip
    """Return the plan for a class with this journal, of which some are `done`; `most` points are full marks."""
    results = journal.all()
    place = next(path for path in (out, *out.absolute().parents) if path.is_dir())
    measures = measured(out, results, keep, most)
    return Plan(submissions, done, trials, at_once, keep, measures, shutil.disk_usage(place).free, journal.damaged)


def measured(out: Path, results: Sequence[dict[str, Any]], keep: str, most: float) -> Measured | None:
    """Return what the last gradings took; None if there were none here."""
    seconds, looked_at = [], []
    for result in reversed(results):
        try:
            took = json.loads((out / result["folder"] / REPORT).read_bytes()).get("wall_seconds")
        except (OSError, ValueError, AttributeError):
            continue
        if isinstance(took, int | float):
            seconds.append(took)
            looked_at.append(result)
        if len(seconds) == LOOKED_AT:
            break
    if not seconds:
        return None
    with_recordings, size = recordings_on_disk(out, looked_at)
    kept = fmean(is_kept(keep, result["score"], most) for result in looked_at)
    return Measured(fmean(seconds), size / with_recordings if with_recordings else 0.0, kept)


def readable_time(seconds: float) -> str:
    """Return a time as people say it: `40 s`, `12 min`, `3 h 20 min`."""
    if seconds < 90:
        return f"{max(1, round(seconds))} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"
