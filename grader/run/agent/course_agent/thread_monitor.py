"""Which threads of this process are at work, and how long the others sleep: in simulated time.

A process has nothing left to do when no thread is at work. A thread counts as at work from its start, except while it
waits in a call that is watched: `python_3_threads.py` and `rclpy_7_1.py` patch those. Who ends the wait of a thread
(with a lock, an event, a message to itself) counts it as at work again, at once and not when it comes to run, so that
there is no moment at which nobody seems to be at work.

A wait with a timeout is a sleep. It ends when the grader orders the one that is due first to wake up; of those due at
the same time, that of the thread that was started first. A sleep takes whole milliseconds, at least one.

The clocks of the process (`time.time()` and its kind) go on with simulated time: that of the latest wake-up or
`/clock`. They begin where the process has last seen them: what it computes before its first node takes no time, what
it sleeps does. They run fast by `AHEAD`, so that a deadline which was computed in floats is reached when its time has
come. A thread that asks the time again and again without waiting is made to wait for a millisecond.
"""

from __future__ import annotations

import _thread
import contextlib
import functools
import math
import time
from collections.abc import Callable, Iterator
from typing import Any

MILLISECOND = 1_000_000  # [ns] of simulated time: the shortest sleep
# `time.time() + 0.3`, asked 0.3 s later, can be a rounding step in the future, 0.24 us: on a real computer every
# wake-up is later than that. A clock that gains 100 us in a second shows 1 us more after a tick of 10 ms, and less than
# a tick more after 100 s.
AHEAD = 100e-6
MOST_READS = 1_000  # of the clock without a wait in between
MOST_POLLS = 3  # of an executor that has nothing to do, without a wait in between
POLL_PERIOD = 0.01  # [s] of simulated time that the next such poll takes at most

# [s] for which no thread at work may have run, all together, until one that has made a node, and not waited since, is
# taken to wait unseen. On a busy machine whoever holds a lock that it needs may get no processor for long.
QUIET = 0.5
LONGEST_LOOK = 0.1  # [s] of that which count between two looks; more is a machine that stood still
# [s] between two looks at least. On a busy machine several orders to look come at once. Two looks at one moment would
# show nobody running, not even threads that only wait for Python's lock, which is passed on every 5 ms.
SHORTEST_LOOK = 0.02

# The clocks and the sleep of the machine, for the agent itself.
monotonic, sleep, time_ns = time.monotonic, time.sleep, time.time_ns


class Wait:
    """One wait of a thread. `wake` ends it, called by another thread; `timed_out` says that its time has come."""

    __slots__ = ("cut", "deadline", "number", "open", "timed_out", "wake")

    def __init__(self, number: int, deadline: int | None, wake: Callable[[], object]) -> None:
        self.number = number
        self.deadline = deadline  # [ns]
        self.wake = wake
        self.open = True
        self.timed_out = False
        self.cut = False  # simulated time has ended; the rest of it is real time


class ThreadMonitor:
    """All watched threads of this process. `on_idle` is called when the last one that was at work begins to wait."""

    def __init__(self) -> None:
        self.lock = _thread.RLock()
        self.on_idle: Callable[[], object] = lambda: None
        self.simulated = False  # whether sleeping takes simulated time
        self.rate = 1.0  # simulated time in a second of the clocks
        self.now_ns = 0
        self.woken = 0  # orders to wake up that were carried out
        self.calling: set[int] = set()  # threads that run a callback
        self._begin_ns = 0
        self._bases: dict[str, int] = {}
        self._slept_ns = 0  # what the first thread has waited in real time
        self._seen: dict[str, tuple[int, int]] = {}  # clock -> what it last showed [ns], and `_slept_ns` then
        self._numbers: dict[int, int] = {}  # ident -> number
        self._next = 0
        self._working: set[int] = set()
        self._waits: dict[int, Wait] = {}
        self._reads: dict[int, int] = {}
        self._polls: dict[int, int] = {}
        self._preparing: set[int] = set()  # threads that have made a node and have not waited since
        self._elsewhere: dict[int, tuple[int, str]] = {}  # number -> native id and what the kernel said of it
        self._looked = 0.0  # [s] the last look
        self._quiet = 0.0  # [s] for which nobody has run since a thread has made a node

    # Threads

    def expect(self) -> int:
        """Return the number of a thread that is about to start; it counts as at work."""
        with self.lock:
            number, self._next = self._next, self._next + 1
            self._working.add(number)
            return number

    def enter(self, number: int) -> None:
        """Say that the calling thread is the one expected."""
        self._numbers[_thread.get_ident()] = number

    def leave(self, number: int | None = None) -> None:
        """Do not watch a thread any more: the calling one, or one that could not be started."""
        if number is None:
            number = self._numbers.pop(_thread.get_ident(), None)
        with self.lock:
            if number is None or number not in self._working:
                return
            self._working.discard(number)
            quiet = not self._working
        if quiet:
            self.on_idle()

    def mine(self) -> int | None:
        """Return the number of the calling thread, None if it is not watched."""
        return self._numbers.get(_thread.get_ident())

    @property
    def idle(self) -> bool:
        """Whether no thread is at work."""
        return not self._working

    # Waits

    def begin(self, deadline: int | None, wake: Callable[[], object]) -> Wait | None:
        """Say that the calling thread is about to wait; None if it is not watched. `end` must follow."""
        with self.lock:
            wait = self.open(deadline, wake)
        if wait is not None and self.idle:
            self.on_idle()
        return wait

    def open(self, deadline: int | None, wake: Callable[[], object]) -> Wait | None:
        """As `begin`, without telling that nobody is at work."""
        number = self.mine()
        if number is None:
            return None
        wait = self._waits[number] = Wait(number, deadline, wake)
        self._reads.pop(number, None)
        self._polls.pop(number, None)
        self._working.discard(number)
        self._preparing.discard(number)
        return wait

    def end(self, wait: Wait | None) -> None:
        """Say that the calling thread waits no more."""
        if wait is not None:
            self.rouse(wait)

    @contextlib.contextmanager
    def waiting(self) -> Iterator[None]:
        """Let the calling thread wait in real time."""
        wait, began = self.begin(None, lambda: None), monotonic()
        try:
            yield
        finally:
            self.end(wait)
            if self.mine() == 0:
                self._slept_ns += round((monotonic() - began) * 1e9)

    @contextlib.contextmanager
    def waiting_for_child(self) -> Iterator[None]:
        """Let the calling thread wait in real time for another process; one that runs a callback counts as at work."""
        with contextlib.nullcontext() if self.mine() in self.calling else self.waiting():
            yield

    def rouse(self, wait: Wait) -> None:
        """Count a thread as at work whose wait is about to end."""
        with self.lock:
            if wait.open:
                wait.open = False
                if self._waits.get(wait.number) is wait:
                    del self._waits[wait.number]
                self._working.add(wait.number)

    @property
    def wakes_ns(self) -> int | None:
        """When the first sleeper is due [ns of simulated time]."""
        with self.lock:
            return min((w.deadline for w in self._waits.values() if w.deadline is not None), default=None)

    def wake(self, now_ns: int, every: bool = False) -> None:
        """Let simulated time go on and wake the sleeper that is due first, or every one that is due."""
        with self.lock:
            self.tell(now_ns)
            self.woken += 1
            due = [w for w in self._waits.values() if w.deadline is not None and w.deadline <= self.now_ns]
            due.sort(key=lambda w: (w.deadline, w.number))
            for wait in due if every else due[:1]:
                wait.timed_out = True
                self.rouse(wait)
                wait.wake()

    def release_all(self) -> None:
        """Let sleeping take real time from now on, also what is left of a sleep."""
        with self.lock:
            self.simulated = False
            for wait in [w for w in self._waits.values() if w.deadline is not None]:
                wait.cut = True
                self.rouse(wait)
                wait.wake()

    @contextlib.contextmanager
    def at_work(self) -> Iterator[None]:
        """Let the calling thread count as at work whatever it does, as one that runs a callback."""
        number = self.mine()
        if number is None or number in self.calling:
            yield
            return
        self.calling.add(number)
        if number not in self._working:  # it had been taken to wait unseen
            self.resume()
        try:
            yield
        finally:
            self.calling.discard(number)

    def working(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return a function that does the same; who calls it counts as at work whatever it waits for."""

        @functools.wraps(function)
        def call(*arguments: Any, **options: Any) -> Any:
            with self.at_work():
                return function(*arguments, **options)

        return call

    def resume(self) -> None:
        """Count the calling thread as at work after a wait that is not watched, and report that."""
        number = self.mine()
        if number is None:
            return
        with self.lock:
            self._working.add(number)
        self.on_idle()

    def prepare(self) -> None:
        """Count the calling thread as at work, which has made a node, until it waits; report that."""
        if (number := self.mine()) is not None:
            self._preparing.add(number)
            self._quiet = 0.0
            self.resume()

    def look_for_strays(self, native: dict[int, int]) -> None:
        """Do not count threads as at work that do not run: they wait in calls that are not watched.

        `native` are the kernel's numbers of threads. If none that is at work has run or wanted to since the last look,
        they stay uncounted until their next watched wait, but for those that run a callback. While one does, another
        may wait for it, such as for a lock that it holds: on a busy machine that takes long. For the same reason
        nobody is taken to wait before `QUIET` while a node is prepared.
        """
        now, before = monotonic(), self._looked
        if now - before < SHORTEST_LOOK:
            return
        said = {}
        for ident, kernel in native.items():
            number = self._numbers.get(ident)
            if number is not None and number in self._working:
                said[number] = (kernel, _scheduled(kernel))
        quiet = all(text and self._elsewhere.get(number) == (kernel, text) for number, (kernel, text) in said.items())
        self._elsewhere, self._looked = said, now
        self._quiet += min(now - before, LONGEST_LOOK) if quiet else 0.0
        if quiet and (self._quiet >= QUIET or not self._preparing & said.keys()):
            with self.lock:
                self._working -= said.keys() - self.calling

    # Time

    def start(self, now_ns: int, rate: float) -> None:
        """Let sleeping take simulated time from now on, and the clocks follow it."""
        with self.lock:
            self.now_ns = self._begin_ns = now_ns
            self.rate = rate
            for name in ("time", "monotonic", "perf_counter"):
                seen, slept = self._seen.get(name, (0, 0))
                self._bases[name] = seen + self._slept_ns - slept if seen else getattr(time, f"{name}_ns")()
            self.simulated = True

    def tell(self, now_ns: int) -> None:
        """Set the simulated time; it never goes back."""
        self.now_ns = max(self.now_ns, now_ns)

    def after(self, seconds: float) -> int | None:
        """Return the simulated time [ns] in some seconds of the clocks; None is never."""
        if seconds * self.rate > 1e9:
            return None
        return self.now_ns + max(1, math.ceil(seconds * self.rate * 1e3 - 1e-6)) * MILLISECOND

    def clock_ns(self, name: str, real: Callable[[], int]) -> int:
        """Return what a clock of the time module shows [ns]."""
        if not self.simulated:
            shown = real()
            self._seen[name] = (shown, self._slept_ns)
            return shown
        number = self.mine()
        if number is not None:
            reads = self._reads[number] = self._reads.get(number, 0) + 1
            if reads > MOST_READS:
                time.sleep(MILLISECOND / 1e9 / self.rate)
        return self._bases[name] + round((self.now_ns - self._begin_ns) * (1 + AHEAD) / self.rate)

    def polls_too_often(self) -> bool:
        """Count a poll of an executor that has nothing to do; return whether the next one must wait."""
        number = self.mine()
        if number is None or not self.simulated:
            return False
        polls = self._polls[number] = self._polls.get(number, 0) + 1
        return polls >= MOST_POLLS


def _scheduled(kernel: int) -> str:
    """Return how often a thread was scheduled, as the kernel counts; empty if it runs."""
    try:
        with open(f"/proc/self/task/{kernel}/status", "rb") as file:  # noqa: PTH123 - pathlib would cost a start
            lines: list[Any] = file.read().decode(errors="replace").splitlines()
    except OSError:
        return ""
    if not any(line.startswith("State:\tS") for line in lines):
        return ""
    return " ".join(line for line in lines if "ctxt_switches" in line)
