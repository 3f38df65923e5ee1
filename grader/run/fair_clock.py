"""A clock that stands still while the processes it follows wait for a processor, so that a busy machine costs no time.

Every patience of the grader is counted by it. It advances while the processes sleep or compute, and stands still while
they could compute and others are in their place. Linux counts that for each thread as its run delay, once the delay is
over; a thread that still waits is ready to run and has not run since the last look. A kernel without these numbers
leaves a clock that shows wall time.

Source: Linux, Documentation/scheduler/sched-stats.rst, section "/proc/<pid>/schedstat"; proc(5), `/proc/pid/stat` and
`/proc/loadavg`.
"""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable, Iterable, Sequence

SAMPLE = 0.1  # [s] of wall time between two looks at the threads
LONGEST_STEP = 5.0  # [s] by which it advances between two looks; more is a machine that stood still
MOST_CREDIT = 1.0  # [s] of delay that is known and not yet subtracted: parallel threads wait at the same time
_NS = 1e-9

Thread = tuple[int, int]  # the ids of its process and its own


class FairClock:
    """Counts time [s] from 0. `processes()` returns the ids of those to follow, without their thread `apart`."""

    def __init__(self, processes: Callable[[], Iterable[int]], apart: int | None = None) -> None:
        self._processes = processes
        self._apart = apart
        self._now = 0.0
        self._idle = 0.0
        self._delayed = 0.0
        self._credit = 0.0
        self._looked = time.monotonic()
        self._threads: dict[Thread, tuple[int, int]] | None = None  # ran, waited [ns]
        self._foreseen: dict[Thread, float] = {}  # [s] of a wait that has not ended, and is subtracted already

    def now(self) -> float:
        """Return the time; it is brought up to date every `SAMPLE` seconds."""
        if self._threads is None or time.monotonic() - self._looked >= SAMPLE:
            self._look()
        return self._now

    def idle(self) -> float:
        """Return the part of the time in which nobody computed."""
        self.now()
        return self._idle

    def delayed(self) -> float:
        """Return for how long it has stood still [s]."""
        self.now()
        return self._delayed

    def _look(self) -> None:
        threads = dict(_threads(self._processes()))
        threads.pop((os.getpid(), self._apart or 0), None)
        now = time.monotonic()
        if self._threads is not None:
            passed = min(now - self._looked, LONGEST_STEP)
            stuck = _ready_to_run([key for key, counts in threads.items() if self._threads.get(key) == counts])
            ran = waited = 0.0
            for key, (total_ran, total_waited) in threads.items():
                before = self._threads.get(key, (0, 0))
                ran += (total_ran - before[0]) * _NS
                if key not in stuck:
                    waited += max(0.0, (total_waited - before[1]) * _NS - self._foreseen.get(key, 0.0))
            self._foreseen = {key: self._foreseen.get(key, 0.0) + passed for key in stuck}
            self._advance(passed, ran, waited, bool(stuck))
        self._threads, self._looked = threads, now

    def _advance(self, passed: float, ran: float, waited: float, stuck: bool) -> None:
        """Advance by at most the time that has passed, and at least by what was computed in it."""
        self._credit = min(self._credit + waited, passed + MOST_CREDIT)
        delayed = passed if stuck else min(self._credit, passed)
        self._credit -= 0.0 if stuck else delayed
        advance = max(passed - delayed, min(ran, passed))
        self._now += advance
        self._delayed += passed - advance
        self._idle += max(0.0, passed - delayed - ran)


class Patience:
    """A wait of at most `seconds` by a fair clock. It costs nothing until it has lasted a while."""

    def __init__(self, clock: FairClock, seconds: float) -> None:
        self._clock, self._seconds = clock, seconds
        self._began = time.monotonic()
        self._since: float | None = None  # by the clock

    def over(self) -> bool:
        """Return whether the wait has lasted too long."""
        return self.waited() > self._seconds

    def waited(self) -> float:
        """Return for how long it has lasted [s], but for the while that costs nothing."""
        if self._since is None:
            if time.monotonic() - self._began < SAMPLE:
                return 0.0
            self._since = self._clock.now()
            self._seconds -= SAMPLE
        return self._clock.now() - self._since


def _ready_to_run(threads: Sequence[Thread]) -> set[Thread]:
    """Return which of some threads, that have not run since the last look, are ready to run."""
    found: set[Thread] = set()
    with contextlib.suppress(OSError, ValueError, IndexError), open("/proc/loadavg", "rb") as file:  # noqa: PTH123
        if int(file.read().split()[3].partition(b"/")[0]) <= len(os.sched_getaffinity(0)):
            return found  # each has a processor
    for process, thread in threads:
        stat = f"/proc/{process}/task/{thread}/stat"
        with contextlib.suppress(OSError, IndexError), open(stat, "rb") as file:  # noqa: PTH123
            if file.read().rpartition(b")")[2].split()[0] == b"R":
                found.add((process, thread))
    return found


def _threads(processes: Iterable[int]) -> Iterable[tuple[Thread, tuple[int, int]]]:
    """Yield for each thread how long it ran and how long it waited for a processor [ns]."""
    for process in processes:
        try:
            threads = os.listdir(f"/proc/{process}/task")  # noqa: PTH208 - looked at ten times a second
        except OSError:
            continue
        for thread in threads:
            with contextlib.suppress(OSError, ValueError, IndexError):
                with open(f"/proc/{process}/task/{thread}/schedstat", "rb") as file:  # noqa: PTH123
                    words = file.read().split()
                yield (process, int(thread)), (int(words[0]), int(words[1]))
