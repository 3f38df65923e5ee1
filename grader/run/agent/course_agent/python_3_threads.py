"""Patches of `threading`, `queue`, `time`, `select` and `signal`: threads and their waits are watched.

In a process with rclpy, `rclpy_7_1.py` calls `install_threads`: threads and their waits are watched from then on
(`thread_monitor.py`), and sleeping takes simulated time. What waits in C (a read from a socket) is not watched, nor
what asks the clock in C (`datetime.now()`).
"""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from typing import Any

from .python_3_os import SIGNALS
from .self_check import Reliance, require
from .thread_monitor import ThreadMonitor, sleep
from .watched_lock import WatchedLock

# Source: threading.py, queue.py and concurrent/futures/thread.py of CPython 3.11.
THREADS: dict[str, Reliance] = {
    "threading:Condition.wait": ("self timeout", "_allocate_lock _waiters acquire"),
    "threading:Condition.notify": ("self n", "_waiters release"),
    "threading:Condition.wait_for": ("self predicate timeout", "_time wait"),
    "threading:Event.wait": ("self timeout", "_cond wait"),
    "threading:Thread.start": ("self", "_bootstrap _started"),
    "threading:Thread._bootstrap_inner": ("self", "run"),
    "threading:Thread.join": ("self timeout", "_started"),
    "threading:_shutdown": ("", ""),
    "queue:Queue.get": ("self block timeout", "time not_empty wait"),
    "queue:Queue.put": ("self item block timeout", "time not_full wait"),
    "queue:_PySimpleQueue.put": ("self item block timeout", "_count release"),
    "concurrent.futures.thread:ThreadPoolExecutor.__init__": ("", "SimpleQueue queue"),
}
CLOCKS = ("time", "monotonic", "perf_counter")

_threads: ThreadMonitor | None = None


def watched() -> ThreadMonitor | None:
    """Return who watches the threads of this process; None if nobody does."""
    return _threads


def at_work() -> AbstractContextManager[None]:
    """Let the calling thread count as at work whatever it does, if threads are watched in this process."""
    return nullcontext() if _threads is None else _threads.at_work()


def install_threads(threads: ThreadMonitor) -> None:
    """Watch the calling thread and those that are started from now on. Raises ImportError if Python is not as expected.

    The calling thread should be the only one that runs code of the submission.
    """
    global _threads
    import queue
    import select
    import signal
    import threading
    import time

    require(THREADS)
    _threads = threads
    threads.enter(threads.expect())
    module: Any = threading
    thread: Any = threading.Thread
    start, bootstrap, join, shutdown = thread.start, thread._bootstrap_inner, thread.join, module._shutdown

    def noted_start(new: Any) -> None:
        new.course_number, new.course_ended = threads.expect(), threading.Event()
        try:
            start(new)
        except BaseException:
            threads.leave(new.course_number)
            raise

    def noted_bootstrap(new: Any) -> None:
        threads.enter(new.course_number)
        try:
            bootstrap(new)
        finally:
            new.course_ended.set()
            threads.leave()

    def watched_join(other: Any, timeout: float | None = None) -> None:
        ended = getattr(other, "course_ended", None)
        if ended is not None and other is not threading.current_thread() and other._started.is_set():
            if not ended.wait(None if timeout is None else max(timeout, 0.0)):
                return
            timeout = None
        join(other, timeout)

    def unwatched_shutdown() -> None:
        others = [each for each in threading.enumerate() if each is not threading.main_thread() and not each.daemon]
        if others:  # else the process ends, which it does at work
            threads.leave()
        shutdown()

    def told_sleep(seconds: Any) -> None:
        if not threads.simulated or threads.mine() is None or not seconds > 0:
            with threads.waiting():
                sleep(seconds)
            return
        lock = WatchedLock(threads)
        lock.acquire()
        lock.acquire(True, seconds)

    def watched(waits: Any) -> Any:
        def wait(*args: Any) -> Any:
            with threads.waiting():
                return waits(*args)

        return wait

    def told_select(reading: Any, writing: Any, failing: Any, timeout: float | None = None) -> Any:
        if not threads.simulated or threads.mine() is None or timeout is None or timeout <= 0:
            return selecting(reading, writing, failing, timeout)
        ready = selecting(reading, writing, failing, 0)
        if any(ready):
            return ready
        told_sleep(timeout)
        return selecting(reading, writing, failing, 0)

    selecting = select.select
    module._allocate_lock = lambda: WatchedLock(threads)
    thread.start, thread._bootstrap_inner, thread.join = noted_start, noted_bootstrap, watched_join
    module._shutdown = unwatched_shutdown
    queue.SimpleQueue = queue._PySimpleQueue  # type: ignore[attr-defined, misc]
    time.sleep, select.select = told_sleep, told_select
    for name in SIGNALS:
        setattr(signal, name, watched(getattr(signal, name)))
    for name in CLOCKS:
        _follow(time, name, threads)
    # These have bound the clock under names of their own.
    module._time = queue.time = time.monotonic  # type: ignore[attr-defined]


def _follow(module: Any, name: str, threads: ThreadMonitor) -> None:
    """Let a clock of the time module follow simulated time."""
    real = getattr(module, f"{name}_ns")

    def nanoseconds() -> int:
        return threads.clock_ns(name, real)

    setattr(module, f"{name}_ns", nanoseconds)
    setattr(module, name, lambda: nanoseconds() / 1e9)
