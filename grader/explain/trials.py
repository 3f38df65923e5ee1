"""Trials: gradings of a submission with one change, side by side, until a budget of processor time is spent.

A trial is a `course grade` like that of a class, in the same box (`whole_class/grading.py`): what it does stays in it.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import resource
from collections.abc import Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.bundle import bundle, digest
from gz_course.grader.exercise.trial import chosen_trials
from gz_course.grader.process.whole_file import write_whole
from gz_course.grader.whole_class.grading import Job, Setup, grade_one
from gz_course.grader.whole_class.versions import versions

PER_SECOND, START_UP = 60.0, 120.0  # [s] of wall time that a trial may take, for each simulated second and besides
KEPT = ("id", "title", "status", "expected", "measured", "points")  # of each check
MOST_KEPT = 2000  # outcomes in the file that keeps them
FULL = "full marks"

Files = dict[str, bytes]


@dataclass(frozen=True)
class Outcome:
    """What a trial earned: points, the checks as the report in JSON has them, and what it says if the text was read."""

    points: float
    checks: tuple[dict[str, Any], ...]
    said: str = ""

    @property
    def passed(self) -> frozenset[str]:
        """The ids of the checks that it passes."""
        return frozenset(each["id"] for each in self.checks if each["status"] == "passed")

    @property
    def failed(self) -> list[dict[str, Any]]:
        """The checks that it fails."""
        return [each for each in self.checks if each["status"] != "passed"]


class Trials:
    """Grades versions of a submission; `spent` grows with each. Call within `gradings_end_here()`."""

    def __init__(
        self, exercise: Exercise, main: str, budget: float, sandbox: str, kept: Path | None, trials: str = "public"
    ) -> None:
        """Prepare to spend `budget` [s] of processor time; outcomes are kept in the file `kept`, by content.

        `trials` are those in which each version runs, as for `course grade`.
        """
        self._main, self._budget, self._kept = main, budget, kept
        course, choice = bundle(exercise, trials)
        seconds = START_UP + PER_SECOND * exercise.duration * len(chosen_trials(exercise, trials))
        options = ("--trials", choice, "--sandbox", sandbox)
        self._first = Setup(exercise.name, course, options, (), seconds)
        self._setup = replace(self._first, options=(*options, "--points-only"))
        self._same = hashlib.sha256(repr((digest(course), choice, versions())).encode()).hexdigest()
        self._before = _processor_seconds()
        self._known = _read(kept, self._same)
        self.count = 0  # of trials, those that were known among them

    @property
    def spent(self) -> float:
        """Processor time [s] of all trials up to now."""
        return _processor_seconds() - self._before

    def run(self, tried: Iterable[Files]) -> Iterator[tuple[int, Outcome | None]]:
        """Yield the number and outcome of each version as it is done, None for one that could not be graded.

        No version is begun when the budget is spent.
        """
        workers = max(1, len(os.sched_getaffinity(0)))
        with ThreadPoolExecutor(workers) as pool:
            numbered = enumerate(tried)
            running: dict[Future[Outcome | None], int] = {}
            try:
                while True:
                    while len(running) < workers and self.spent < self._budget:
                        number, files = next(numbered, (-1, None))
                        if files is None:
                            break
                        running[pool.submit(self.grade, files)] = number
                    if not running:
                        return
                    for done in wait(running, return_when=FIRST_COMPLETED).done:
                        number = running.pop(done)
                        yield number, done.result()
            finally:
                for each in running:
                    each.cancel()

    def grade(self, files: Files, *, explained: bool = False) -> Outcome | None:
        """Return the outcome of one version, None if it could not be graded; `explained` also reads its text."""
        key = digest(files)
        if key not in self._known or (explained and not self._known[key].said):
            setup = self._first if explained else self._setup
            graded = grade_one(setup, Job("", key, "", self._main, files))
            if graded.report is None or graded.report["outcome"] == "infra":
                return None
            checks = tuple({name: each[name] for name in KEPT} for each in graded.report["checks"])
            said = graded.report["diagnosis"] or FULL if explained else ""
            self._known[key] = Outcome(graded.report["score"], checks, said)
        self.count += 1
        return self._known[key]

    def keep(self) -> None:
        """Write what was found out; a disk that is full costs nothing but the next search's time."""
        if self._kept is None:
            return
        newest = list(self._known.items())[-MOST_KEPT:]
        content = {"same": self._same, "outcomes": {key: [each.points, each.checks, each.said] for key, each in newest}}
        with contextlib.suppress(OSError):
            self._kept.parent.mkdir(parents=True, exist_ok=True)
            write_whole(self._kept, json.dumps(content).encode())


def _read(file: Path | None, same: str) -> dict[str, Outcome]:
    """Return the outcomes in a file that are of the same exercise and versions; what cannot be read counts as none."""
    try:
        content = json.loads(file.read_bytes()) if file is not None else {}
        if content.get("same") != same:
            return {}
        return {
            key: Outcome(points, tuple(checks), said) for key, (points, checks, said) in content["outcomes"].items()
        }
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}


def _processor_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
