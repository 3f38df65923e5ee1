"""A pool of processes that grade at the same time; results come in the order of the jobs.

A worker ends with its parent, and what it runs ends with it. One job at a time needs no worker.
"""

from __future__ import annotations

import contextlib
import ctypes
import multiprocessing
import os
import signal
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.trial import Trial
from gz_course.grader.grade import grade
from gz_course.grader.process.interruption import end_on, undisturbed
from gz_course.grader.process.temporary_folder import TemporaryFolder
from gz_course.grader.report.report import Report
from gz_course.grader.verify.kept import read, write

PR_SET_PDEATHSIG = 1
PATIENCE = 10.0  # [s] for a worker to end what it runs
ATTEMPTS = 3  # at a grading that fails because of the machine


@dataclass(frozen=True)
class Job:
    """One grading: `file` is what is submitted; the recordings go to the folder `out`.

    `trials` is a list of groups: a group is run only if those before it earned full marks. `kept` is where the report
    stays until the proof is complete.
    """

    exercise: Exercise
    file: Path
    out: Path
    trials: tuple[tuple[Trial, ...], ...]
    kept: Path | None = None

    @property
    def done(self) -> bool:
        """Whether an earlier command left the report."""
        return self.kept is not None and self.kept.is_file()

    def run(self) -> Report:
        """Return the report: that of an earlier command, else grade."""
        if self.kept is None:
            return self._run()
        report = read(self.kept)
        if report is None:
            report = self._run()
            write(self.kept, report)
        return report

    def _run(self) -> Report:
        first, *others = self.trials
        report = self._grade(first, self.out)
        for number, trials in enumerate(others, 1):
            if not report.full_marks:
                break
            report = self._grade(trials, self.out / str(number))
        return report

    def _grade(self, trials: tuple[Trial, ...], out: Path) -> Report:
        for _ in range(ATTEMPTS - 1):
            with contextlib.suppress(InfrastructureError):
                report = grade(self.exercise, self.file, out, trials=trials)
                if report.score.outcome != "infra":
                    return report
        return grade(self.exercise, self.file, out, trials=trials)


class Pool(Protocol):
    """The interface of a pool."""

    def reports(self, jobs: Sequence[Job]) -> Iterator[Report]:
        """Yield the report on each job, in their order."""


class Here:
    """Grades one job after another in this process."""

    def reports(self, jobs: Sequence[Job]) -> Iterator[Report]:
        """Yield the report on each job; a job is graded when its report is requested."""
        return (job.run() for job in jobs)


class Workers:
    """Grades in `count` processes."""

    def __init__(self, count: int, folder: str) -> None:
        """Start with temporary files in `folder`, which the caller removes, because a killed worker cannot."""
        spawn = multiprocessing.get_context("spawn")  # a fork would inherit the threads of DDS and of the recorder
        self._pool = ProcessPoolExecutor(count, mp_context=spawn, initializer=_begin, initargs=(os.getpid(), folder))

    def reports(self, jobs: Sequence[Job]) -> Iterator[Report]:
        """Yield the report on each job; all are submitted at the first request.

        Raises what grading raises, InfrastructureError if a worker died.
        """
        futures: list[Future[Report]] = [self._pool.submit(_run, job) for job in jobs]
        try:
            for future in futures:
                yield future.result()
        except BrokenProcessPool:
            raise InfrastructureError("a process that graded variants was killed; was memory short?") from None
        finally:
            for future in futures:
                future.cancel()

    def close(self, *, at_once: bool) -> None:
        """End the workers; `at_once` terminates what they are doing, and kills who has not ended after `PATIENCE`."""
        if at_once:
            # A worker that a signal has reached while it took the order to end waits for another one for ever.
            workers = multiprocessing.active_children()
            for process in workers:
                process.terminate()
            self._pool.shutdown(wait=False, cancel_futures=True)
            for process in workers:
                process.join(PATIENCE)
                process.kill()
        self._pool.shutdown(wait=True, cancel_futures=True)


@contextlib.contextmanager
def pool(count: int) -> Iterator[Pool]:
    """Yield a pool of `count` processes; nothing is left running after the block."""
    if count == 1:
        yield Here()
        return
    with TemporaryFolder("course-workers-") as folder:
        workers = Workers(count, str(folder))
        try:
            yield workers
        except BaseException:
            with undisturbed():
                workers.close(at_once=True)
            raise
        workers.close(at_once=False)


def _begin(parent: int, folder: str) -> None:
    """Initialise a worker, which ends in an orderly way with its parent."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        sys.exit(3)
    tempfile.tempdir = folder
    # Ctrl-C in a terminal reaches the parent as well, which ends the worker
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    end_on(signal.SIGTERM)


def _run(job: Job) -> Report:
    return job.run()
