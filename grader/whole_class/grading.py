"""The grading of one submission of a class: a `course grade` in its own process group and folder, with a deadline.

`grade_one` takes bytes and returns bytes, so it works in a thread here and on a Dask worker that shares no files with
this machine. A failure of the machine or the grader is named in `Graded.fault` and is never a score.
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import os
import signal
import subprocess
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import psutil

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.exercise import bundle
from gz_course.grader.printable import shown
from gz_course.grader.process.temporary_folder import TemporaryFolder, sweep
from gz_course.grader.report.format import formats
from gz_course.grader.whole_class.forked_process import ForkedProcess, ForkServer

PR_SET_CHILD_SUBREAPER = 36
LARGEST_FILE = 256 << 20  # [bytes] of a recording or report that is returned
GRACE = 3.0  # [s] between SIGINT, SIGTERM and SIGKILL
ERROR_TAIL = 4096  # [bytes] of the error output of a failed grading that are read
REPORT = "report.json"
RECORDINGS = "recordings"
OF_REPORT = ("score", "outcome", "diagnosis", "truth_sha256")  # what a result takes from a report


@dataclass(frozen=True)
class Setup:
    """What all gradings of a class have in common. `deadline` [s] is for one grading."""

    exercise: str
    course: dict[str, bytes]  # the exercise's files, by path below a course's root
    options: tuple[str, ...]  # of `course grade`
    reports: tuple[str, ...]  # formats besides JSON
    deadline: float
    folder: str | None = None  # where working folders are made; None: in the system's folder for temporary files


@dataclass(frozen=True)
class Job:
    """One student's submission, read into memory."""

    student: str
    key: str  # identifies submission, exercise, options and versions: equal keys, equal results
    source: str
    main: str
    files: dict[str, bytes] = field(repr=False)


@dataclass(frozen=True)
class Graded:
    """The result of a grading: the JSON report and its files (relative names), or why there is none."""

    report: dict[str, Any] | None
    files: dict[str, bytes] = field(default_factory=dict, repr=False)
    fault: str | None = None


class _Running:
    """The gradings that now run in this process, so that all of them can be ended."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._server = ForkServer()
        self._processes: set[ForkedProcess] = set()
        self.stopped = False

    def start(self, folder: Path, arguments: list[str], environment: dict[str, str]) -> ForkedProcess:
        with self._lock:
            if self.stopped:
                raise InterruptedError("the class was interrupted")
            process = self._server.start(folder, arguments, environment)
            self._processes.add(process)
            return process

    def ended(self, process: ForkedProcess) -> None:
        """Forget a process, and kill the orphans it left in other sessions, which are now children of this process."""
        children = psutil.Process().children()
        with self._lock:  # whoever was a child before is known now
            self._processes.discard(process)
            running = {self._server.pid, *(each.pid for each in self._processes)}
        for child in children:
            with contextlib.suppress(psutil.Error, OSError):
                if child.pid not in running and os.getsid(child.pid) != os.getsid(0) and child.pid != process.pid:
                    child.kill()
                    child.wait(GRACE)

    def begin(self) -> None:
        with self._lock:
            self._server.close()
            self._server, self.stopped = ForkServer(), False

    def stop(self) -> None:
        self.stopped = True
        self._server.stop()
        with self._lock:
            self._server.close()
            processes = list(self._processes)
        for process in processes:
            end(process)


RUNNING = _Running()


@contextlib.contextmanager
def gradings_end_here() -> Iterator[None]:
    """End every grading of this process when the block is left, and start none afterwards."""
    RUNNING.begin()
    try:
        yield
    finally:
        RUNNING.stop()


def grade_one(setup: Setup, job: Job) -> Graded:
    """Grade one submission; called in a thread of this process or of a Dask worker."""
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)  # makes the orphans of a killed grading children of this process
    if setup.folder is None:  # on a Dask worker nobody else removes what killed gradings left
        sweep()
    try:
        temporary = TemporaryFolder("course-class-", setup.folder)
    except OSError as error:
        return Graded(None, fault=f"no temporary folder: {error.strerror}")
    try:
        return _grade(setup, job, temporary.path)
    except InfrastructureError as error:
        return Graded(None, fault=str(error))
    except OSError as error:
        return Graded(None, fault=f"{type(error).__name__}: {error}")
    finally:
        temporary.close()


def _grade(setup: Setup, job: Job, folder: Path) -> Graded:
    bundle.write(setup.course, folder / "course")
    bundle.write(job.files, folder / "submission")
    (folder / "tmp").mkdir()
    submission = folder / "submission"
    # A single file may have any name; a folder is searched for the expected one.
    given = submission / job.main if len(job.files) == 1 else submission
    arguments = [
        "grade",
        setup.exercise,
        "--submission",
        str(given),
        "--out",
        RECORDINGS,
        "--json",
        REPORT,
        "--no-page",
    ]
    arguments += setup.options
    for name in setup.reports:
        arguments += [f"--{name}", formats()[name].file]
    environment = os.environ | {"COURSE_ROOT": str(folder / "course"), "TMPDIR": str(folder / "tmp")}
    with (folder / "stderr").open("w+b") as errors:
        process = RUNNING.start(folder, arguments, environment)
        try:
            late = False
            try:
                process.wait(setup.deadline)
            except subprocess.TimeoutExpired:
                late = True
        finally:
            code = end(process)
            RUNNING.ended(process)
        if late:
            return Graded(None, fault=f"the grading was not done after {setup.deadline:g} s")
        errors.seek(max(0, errors.seek(0, os.SEEK_END) - ERROR_TAIL))
        said = shown(errors.read().decode(errors="replace").strip().rpartition("\n")[2])
    if code not in (0, 1):
        how = f"signal {-code}" if code < 0 else f"exit code {code}"
        return Graded(None, fault=f"the grading ended with {how}{': ' if said else ''}{said}")
    return _bring_back(setup, job, folder)


def end(process: ForkedProcess) -> int:
    """End a grading and its process group: SIGINT, SIGTERM, SIGKILL; return its exit code.

    One that has ended by itself is only reaped.
    """
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        if process.poll() is not None:
            break
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, number)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(GRACE)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    return process.wait()


def _bring_back(setup: Setup, job: Job, folder: Path) -> Graded:
    """Read report and recordings; make paths relative to the temporary folder, which the report must not show."""
    paths = [folder / REPORT, *(folder / formats()[name].file for name in setup.reports)]
    paths += sorted((folder / RECORDINGS).glob("*.rrd"))
    files: dict[str, bytes] = {}
    for path in paths:
        if path.stat().st_size > LARGEST_FILE:
            return Graded(None, fault=f"{path.name} has {path.stat().st_size} bytes; at most {LARGEST_FILE} are kept")
        data = path.read_bytes()
        files[path.name] = data if path.suffix == ".rrd" else data.replace(f"{folder}/".encode(), b"")
    try:
        report = json.loads(files[REPORT])
        report["submission"] = job.source
        for place in (report, *report["trials"]):
            place["recording"] = Path(place["recording"]).name
        score, most = report["score"], report["max_score"]
        if not (isinstance(score, int | float) and 0 <= score <= most and isinstance(report["outcome"], str)):
            raise ValueError(f"score {score!r} of {most!r}")
    except (ValueError, KeyError, TypeError) as error:
        return Graded(None, fault=f"the grading left no report that can be read: {error}")
    files[REPORT] = (json.dumps(report, indent=2) + "\n").encode()
    return Graded(report, files)
