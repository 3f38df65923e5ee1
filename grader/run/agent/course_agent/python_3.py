"""Patches of `subprocess` and `asyncio`: they report which processes this one starts, and when it only waits.

`import_hooks.py` calls `install_subprocess` and `install_asyncio` when those modules are imported. A new Python process
needs a while until it can report anything, so its parent announces it. Event loops (`ros2 launch` is one) and processes
that wait for a child are reported as waiting, so that simulated time does not stand still for them. Timers of such a
loop (how long a launch waits after Ctrl-C before it escalates) follow the clock of the run, which the grader keeps; so
do timeouts of waits for a child, and what our programs wait for by `sim/machine_clock.py`. A wait for another process
takes real time.
"""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from types import SimpleNamespace
from typing import Any

from .channel import SOCKET, channel
from .grader_requests import ask
from .python_3_threads import at_work, watched
from .self_check import Reliance, require
from .thread_monitor import ThreadMonitor, monotonic, sleep

SOON = 10.0  # [s] a timer of an event loop that is due within this time, such as a TimerAction, is waited for
SLICE = 0.5  # [s] of a wait for a message, after which it is looked whether simulated time has begun
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

_waiting = False
_asked_at = -1.0  # [s] of real time
_delayed: list[float] = []  # [s] for which the clock of the run had stood still, at first and as last asked for


def install_subprocess() -> None:
    """Start to report which processes start and end. Raises ImportError if `subprocess` is not as expected."""
    import subprocess

    require(SUBPROCESS)
    module: Any = subprocess
    # A child lives in real time, and so does the wait for it: it looks again and again, sleeping in between.
    module._time, module.time = _run_time, SimpleNamespace(sleep=sleep)
    process_class: Any = subprocess.Popen
    start, ended = process_class.__init__, process_class._handle_exitstatus

    def told_start(process: Any, *args: Any, **kwargs: Any) -> None:
        start(process, *args, **kwargs)
        tell_start(process.pid, kwargs.get("env"), sys._getframe(1).f_globals.get("__name__", ""))

    def told_end(process: Any, *args: Any, **kwargs: Any) -> None:
        ended(process, *args, **kwargs)
        tell_end(process.pid, process.returncode)

    def told_wait(method: Any) -> Any:
        def wait(process: Any, *args: Any, **kwargs: Any) -> Any:
            if process.returncode is None:
                _wait_begins()
            with waiting_for_child(told=False):
                return method(process, *args, **kwargs)

        return wait

    process_class.__init__ = told_start
    process_class._handle_exitstatus = told_end
    for name in ("_wait", "_communicate"):
        setattr(process_class, name, told_wait(getattr(process_class, name)))


def install_asyncio() -> None:
    """Start to report when an event loop is about to wait. Raises ImportError if `asyncio` is not as expected."""
    from asyncio import base_events, selector_events

    require(ASYNCIO)
    loops: Any = base_events.BaseEventLoop
    once, loop_time = loops._run_once, loops.time
    writer: Any = selector_events.BaseSelectorEventLoop
    write = writer._write_to_self

    def fair_time(loop: Any) -> float:
        threads = watched()
        if (threads is None or not threads.simulated) and monotonic() - _asked_at > KNOWN_FOR:
            _ask_for_delay()
        return float(loop_time(loop)) - _delay()

    def noted_write(loop: Any) -> None:
        threads = watched()
        if threads is not None and (wait := getattr(loop, "course_wait", None)) is not None:
            threads.rouse(wait)
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
        threads = watched()
        if threads is not None and not (threads.simulated and threads.mine() is not None):
            threads = None
        if not loop._ready and not loop._stopping and threads is not None:
            ready = loop._selector.select(0)
            if ready:
                loop._process_events(ready)
            else:
                sleep_until_due(loop, threads)
        elif not loop._ready and not loop._stopping:
            ready = loop._selector.select(0)
            if ready:
                loop._process_events(ready)
            elif not any(not each._cancelled and each._when < loop.time() + SOON for each in loop._scheduled):
                _wait_begins()
        once(loop)

    loops._run_once, loops.time = told_run_once, fair_time
    writer._write_to_self = noted_write


def install_machine_clock() -> None:
    """Let waits of our own programs for the machine follow the clock of the run, whatever simulated time does."""
    from gz_course.sim import machine_clock

    def pause(seconds: float) -> None:
        with at_work():
            sleep(seconds)

    def await_event(event: Any, seconds: float) -> bool:
        end = _run_time() + seconds
        while not event.is_set() and (left := end - _run_time()) > 0:
            threads = watched()
            simulated = threads is not None and threads.simulated and threads.mine() is not None
            event.wait(left if simulated else min(left, SLICE))
        return bool(event.is_set())

    machine_clock.now, machine_clock.pause, machine_clock.await_event = _run_time, pause, await_event


def tell_start(pid: int, environment: Any, caller: str) -> None:
    """Report a process that the module `caller` has started in an environment (None: that of this process)."""
    mute = environment is not None and not {SOCKET, SOCKET.encode()} & set(environment)  # it cannot find the grader
    ours = caller.startswith("gz_course.")  # as when an action of a launch starts a program
    _tell({"started": {"pid": pid, "program": "" if mute else _program(pid), "ours": ours}})


def tell_end(pid: int, code: int) -> None:
    """Report that a child has ended, as its parent has noticed."""
    _resume()  # before the end is known, so that time does not go on meanwhile
    _tell({"ended": {"pid": pid, "code": code}})


@contextmanager
def waiting_for_child(told: bool = True) -> Iterator[None]:
    """Let the calling thread wait for another process, and on wish report first that this one only waits."""
    if told:
        _wait_begins()
    threads = watched()
    with nullcontext() if threads is None else threads.waiting_for_child():
        try:
            yield
        finally:
            _resume()


@contextmanager
def waiting() -> Iterator[None]:
    """Report that this process only waits, for a signal, and that it goes on."""
    if watched() is not None:  # its threads are watched one by one
        yield
        return
    _wait_begins()
    try:
        yield
    finally:
        _tell({"awake": True})


def _run_time() -> float:
    """Return the time [s] without what the run waited for a processor."""
    _ask_for_delay()
    return monotonic() - _delay()


def _delay() -> float:
    return _delayed[-1] - _delayed[0] if _delayed else 0.0


def _ask_for_delay() -> None:
    """Ask the grader for how long the clock of the run has stood still."""
    global _asked_at
    told = ask({"time": True}) if channel().open else {}
    if "delayed" in told:
        _delayed.append(told["delayed"])
        del _delayed[1:-1]
    _asked_at = monotonic()


def _resume() -> None:
    if (threads := watched()) is not None:
        threads.resume()


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
