"""Small Python programs in separate processes, for tests that may hang or crash.

All end at one deadline at the latest. It is counted by a clock that stands still while they wait for a processor, so a
busy machine makes nothing look broken. What has computed most of its time is slow (`TooSlow`), what has waited is
broken (`ProbeError`). Each sets an alarm, in case this process is killed.
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Mapping
from types import TracebackType
from typing import IO

import psutil

from gz_course.grader.process.load import crowded
from gz_course.grader.process.temporary_folder import TemporaryFolder
from gz_course.grader.run.fair_clock import FairClock
from gz_course.grader.run.sandbox.resource_monitor import descendants

GRACE = 0.3  # [s] between SIGINT, SIGTERM and SIGKILL
LOOK_AGAIN = 0.05  # [s] between two looks at the time while a program runs
STARVED = 120.0  # [s] of wall time more than the deadline, after which nothing is waited for
AT_WORK = 0.5  # part of its time in which a program computed that is slow, not broken
_ALARM = "import signal; signal.alarm({seconds})\n"


class ProbeError(Exception):
    """A probe failed; the text is the last line of its error output."""


class TooSlow(Exception):
    """A probe was still at work when its time was over, which says nothing against what it tried."""


class Probe:
    """A running program; its standard input stays open until `result()` or `stop()`."""

    def __init__(self, code: str, arguments: tuple[str, ...], environment: Mapping[str, str], probes: Probes) -> None:
        """Start the Python code `code`; `environment` is added to this process's own."""
        self._probes = probes
        self._began = probes.seconds()
        # Files, not pipes: a child that outlives the program would keep a pipe open, and this process waiting.
        self._output, self._errors = (tempfile.TemporaryFile(dir=probes.folder) for _ in range(2))  # noqa: SIM115
        alarm = _ALARM.format(seconds=int(probes.wall_seconds_left + 2))
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-c", alarm + code, *arguments],
                cwd=probes.folder,  # nothing is imported from the current folder, such as somebody's rclpy.py
                env=dict(environment),
                stdin=subprocess.PIPE,
                stdout=self._output,
                stderr=self._errors,
                start_new_session=True,
            )
        except OSError:
            self._output.close()
            self._errors.close()
            raise

    def result(self, within: float | None = None) -> str:
        """Wait for its end; return what it printed.

        `within` [s] is its own deadline, if that is earlier. Raises ProbeError if it failed or hangs, TooSlow if it was
        still at work at the end.
        """
        try:
            self._close_input()
            self._await_end(self._probes.deadline if within is None else within)
            output, errors = _text(self._output), _text(self._errors)
        finally:
            self.stop()
        code = self._process.returncode
        if code:
            told = [line.strip() for line in errors.splitlines() if line.strip()]
            how = f"ended by {_signal_name(-code)}" if code < 0 else f"ended with exit code {code}"
            raise ProbeError(told[-1] if told and code > 0 else how)
        return output.strip()

    def _await_end(self, within: float) -> None:
        """Wait until it has ended. Raises ProbeError or TooSlow if its time is over before that."""
        while True:
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(LOOK_AGAIN)
                return
            passed = self._probes.seconds() - self._began
            late = passed > within or self._probes.seconds_left <= 0
            if late or self._probes.wall_seconds_left <= 0:
                told = f"no answer within {min(within, self._probes.deadline):g} s"
                computed = self._computed()
                if not late or computed > AT_WORK * passed:
                    raise TooSlow(f"{told}, but it was at work and had {computed:.1f} s of processor time")
                if crowded():
                    raise TooSlow(f"{told}, of which it had a processor for {computed:.1f} s: this machine is crowded")
                raise ProbeError(told)

    def _computed(self) -> float:
        """Return the processor time of the program and what it started [s]."""
        used = 0.0
        for pid in (self._process.pid, *descendants(self._process.pid)):
            with contextlib.suppress(psutil.Error):
                times = psutil.Process(pid).cpu_times()
                used += times.user + times.system + times.children_user + times.children_system
        return used

    def stop(self) -> None:
        """End it, first with SIGINT, and discard its output."""
        for number in (signal.SIGINT, signal.SIGTERM):
            if self._process.poll() is None:
                self._kill(number)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    self._process.wait(GRACE)
        self._kill(signal.SIGKILL)  # everything it started and did not end
        self._process.wait()
        self._close_input()
        self._output.close()
        self._errors.close()

    def _close_input(self) -> None:
        if self._process.stdin is not None:
            with contextlib.suppress(OSError):
                self._process.stdin.close()

    def _kill(self, number: signal.Signals) -> None:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, number)


def _text(stream: IO[bytes]) -> str:
    stream.seek(0)
    return stream.read().decode(errors="replace")


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


class Probes:
    """Starts probes in a private folder, and ends them all; a context manager, usable from many threads."""

    def __init__(self, deadline: float) -> None:
        """Allow all probes together `deadline` [s], on a machine that hardly gives them a processor `STARVED` [s]."""
        self.deadline = deadline
        self._wall_end = time.monotonic() + deadline + STARVED
        self._clock = FairClock(lambda: [os.getpid(), *descendants(os.getpid())])
        self._clock.now()
        self._clock_lock = threading.Lock()
        self._temporary = TemporaryFolder("course-doctor-")
        self.folder = self._temporary.path
        self._lock = threading.Lock()
        self._started: list[Probe] = []
        self._open = True

    def seconds(self) -> float:
        """Return the time since the beginning [s], without that in which they waited for a processor."""
        with self._clock_lock:
            return self._clock.now()

    @property
    def seconds_left(self) -> float:
        """Return the time until the deadline [s]; negative after it."""
        return self.deadline - self.seconds()

    @property
    def wall_seconds_left(self) -> float:
        """Return the wall time until everything ends, however little was done [s]; negative after it."""
        return self._wall_end - time.monotonic()

    def start(self, code: str, *arguments: str, environment: Mapping[str, str] | None = None) -> Probe:
        """Start Python code; `environment` is added to this process's own. Raises ProbeError if that is impossible."""
        with self._lock:
            if self.wall_seconds_left <= 0:
                raise TooSlow(f"no answer within {STARVED + self.deadline:g} s of a machine that does other things")
            if not self._open or self.seconds_left <= 0:
                told = f"no answer within {self.deadline:g} s"
                raise TooSlow(f"{told}: this machine is crowded") if crowded() else ProbeError(told)
            try:
                probe = Probe(code, arguments, os.environ | dict(environment or {}), self)
            except OSError as error:
                raise ProbeError(f"Python does not start: {error}") from None
            self._started.append(probe)
            return probe

    def run(
        self, code: str, *arguments: str, environment: Mapping[str, str] | None = None, within: float | None = None
    ) -> str:
        """Run Python code to its end; return what it printed. Raises ProbeError and TooSlow as `Probe.result`."""
        return self.start(code, *arguments, environment=environment).result(within)

    def close(self) -> None:
        """End every probe, and remove the folder."""
        with self._lock:
            self._open = False
            started, self._started = self._started, []
        for probe in started:
            probe.stop()
        self._temporary.close()

    def __enter__(self) -> Probes:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
