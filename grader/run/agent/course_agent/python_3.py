"""All patches of the standard library: they report which processes this one starts, and when it only waits.

`import_hooks.py` calls `install_subprocess` and `install_asyncio` when those modules are imported. A new Python process
needs a while until it can report anything, so its parent announces it. Event loops (`ros2 launch` is one) and processes
that wait for a child are reported as waiting, so that simulated time does not stand still for them. Timers of such a
loop (how long a launch waits after Ctrl-C before it escalates) follow the clock of the run, which the grader keeps; so
do timeouts of waits for a child.

In a process with rclpy, `rclpy_7_1.py` calls `install_threads`: threads and their waits are watched from then on
(`thread_monitor.py`), and sleeping takes simulated time. A wait for another process takes real time. What waits in C (a
read from a socket) is not watched, nor what asks the clock in C (`datetime.now()`).
"""

from __future__ import annotations

import math
import os
import sys
from contextlib import AbstractContextManager, nullcontext
from types import SimpleNamespace
from typing import Any

from .channel import SOCKET, channel
from .self_check import Reliance, misfits
from .thread_monitor import ThreadMonitor, WatchedLock, monotonic, sleep

SOON = 10.0  # [s] a timer of an event loop that is due within this time, such as a TimerAction, is waited for
KNOWN_FOR = 0.05  # [s] after which an event loop asks again for the clock of the run
# Source: subprocess.py and asyncio/ of CPython 3.11 to 3.14.
SUBPROCESS: dict[str, Reliance] = {
    "subprocess:Popen.__init__": ("", "returncode pid"),
    "subprocess:Popen._handle_exitstatus": ("", "returncode"),
    "subprocess:Popen._wait": ("self timeout", "_time time sleep"),
    "subprocess:Popen._communicate": ("self input endtime orig_timeout", ""),
}
ASYNCIO: dict[str, Reliance] = {
    "asyncio.base_events:BaseEventLoop.time": ("self", "time monotonic"),
    "asyncio.base_events:BaseEventLoop._run_once": ("self", "_scheduled _ready _stopping _selector _process_events"),
    "asyncio.events:TimerHandle.__init__": ("", "_when"),
    "asyncio.events:Handle.__init__": ("", "_cancelled"),
    "asyncio.selector_events:BaseSelectorEventLoop._write_to_self": ("self", ""),
}
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
SIGNALS = ("pause", "sigtimedwait", "sigwait", "sigwaitinfo")  # calls that wait for a signal

_waiting = False
_asked_at = -1.0  # [s] of real time
_delayed: list[float] = []  # [s] for which the clock of the run had stood still, at first and as last asked for
_threads: ThreadMonitor | None = None


def install_subprocess() -> None:
    """Start to report which processes start and end. Raises ImportError if `subprocess` is not as expected."""
    import subprocess

    _check(SUBPROCESS)
    module: Any = subprocess
    # A child lives in real time, and so does the wait for it: it looks again and again, sleeping in between.
    module._time, module.time = _run_time, SimpleNamespace(sleep=sleep)
    process_class: Any = subprocess.Popen
    start, ended = process_class.__init__, process_class._handle_exitstatus

    def told_start(process: Any, *args: Any, **kwargs: Any) -> None:
        start(process, *args, **kwargs)
        mute = kwargs.get("env") is not None and SOCKET not in kwargs["env"]  # it cannot find the grader
        caller = sys._getframe(1).f_globals.get("__name__", "")
        ours = caller.startswith("gz_course.")  # as when an action of a launch starts a program
        _tell({"started": {"pid": process.pid, "program": "" if mute else _program(process.pid), "ours": ours}})

    def told_end(process: Any, *args: Any, **kwargs: Any) -> None:
        ended(process, *args, **kwargs)
        _resume()  # before the end is known, so that time does not go on meanwhile
        _tell({"ended": {"pid": process.pid, "code": process.returncode}})

    def told_wait(method: Any) -> Any:
        def wait(process: Any, *args: Any, **kwargs: Any) -> Any:
            if process.returncode is None:
                _wait_begins()
            with nullcontext() if _threads is None else _threads.waiting_for_child():
                try:
                    return method(process, *args, **kwargs)
                finally:
                    _resume()

        return wait

    process_class.__init__ = told_start
    process_class._handle_exitstatus = told_end
    for name in ("_wait", "_communicate"):
        setattr(process_class, name, told_wait(getattr(process_class, name)))


def install_asyncio() -> None:
    """Start to report when an event loop is about to wait. Raises ImportError if `asyncio` is not as expected."""
    from asyncio import base_events, selector_events

    _check(ASYNCIO)
    loops: Any = base_events.BaseEventLoop
    once, loop_time = loops._run_once, loops.time
    writer: Any = selector_events.BaseSelectorEventLoop
    write = writer._write_to_self

    def fair_time(loop: Any) -> float:
        if (_threads is None or not _threads.simulated) and monotonic() - _asked_at > KNOWN_FOR:
            _ask_for_delay()
        return float(loop_time(loop)) - _delay()

    def noted_write(loop: Any) -> None:
        if _threads is not None and (wait := getattr(loop, "course_wait", None)) is not None:
            _threads.rouse(wait)
        write(loop)

    def sleep_until_due(loop: Any, threads: ThreadMonitor) -> None:
        """Wait for an event, or in simulated time for the next timer."""
        times = [each._when for each in loop._scheduled if not each._cancelled]
        left = min(times) - loop.time() if times else math.inf
        if left <= 0:
            return
        loop.course_wait = wait = threads.begin(threads.after(left), lambda: write(loop))
        try:
            events = loop._selector.select(None)
        finally:
            threads.end(wait)
            loop.course_wait = None
        loop._process_events(events)

    def told_run_once(loop: Any) -> None:
        simulated = _threads is not None and _threads.simulated and _threads.mine() is not None
        if not loop._ready and not loop._stopping and simulated:
            assert _threads is not None
            ready = loop._selector.select(0)
            if ready:
                loop._process_events(ready)
            else:
                sleep_until_due(loop, _threads)
        elif not loop._ready and not loop._stopping:
            ready = loop._selector.select(0)
            if ready:
                loop._process_events(ready)
            elif not any(not each._cancelled and each._when < loop.time() + SOON for each in loop._scheduled):
                _wait_begins()
        once(loop)

    loops._run_once, loops.time = told_run_once, fair_time
    writer._write_to_self = noted_write


def _run_time() -> float:
    """Return the time [s] without what the run waited for a processor."""
    _ask_for_delay()
    return monotonic() - _delay()


def _delay() -> float:
    return _delayed[-1] - _delayed[0] if _delayed else 0.0


def _ask_for_delay() -> None:
    """Ask the grader for how long the clock of the run has stood still."""
    global _asked_at
    from .grader_requests import ask

    told = ask({"time": True}) if channel().open else {}
    if "delayed" in told:
        _delayed.append(told["delayed"])
        del _delayed[1:-1]
    _asked_at = monotonic()


def _resume() -> None:
    if _threads is not None:
        _threads.resume()


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

    _check(THREADS)
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


def _check(relied_upon: dict[str, Reliance]) -> None:
    if found := misfits(relied_upon):
        raise ImportError(f"this Python cannot be kept in step: {found[0]}")


def _wait_begins() -> None:
    global _waiting
    if not _waiting:
        _waiting = True
        channel().send({"waiting": True})


def _tell(message: dict[str, Any]) -> None:
    global _waiting
    _waiting = False
    channel().send(message)


def _program(pid: int) -> str:
    """Return the program a process runs; empty for a Python that ignores its environment, and thereby the agent."""
    command = b""
    try:
        while not command:  # for a moment after Popen returned, the process has no command line yet
            name = os.path.basename(os.readlink(f"/proc/{pid}/exe"))  # noqa: PTH115, PTH119 - pathlib would cost a start
            with open(f"/proc/{pid}/cmdline", "rb") as file:  # noqa: PTH123
                command = file.read()
    except OSError:  # it has ended
        return ""
    if name.startswith("python"):
        for word in command.decode(errors="replace").split("\0")[1:]:
            if not word.startswith("-") or word in ("-c", "-m"):
                break
            if not word.startswith("--") and set("IES") & set(word):
                return ""
    return name
