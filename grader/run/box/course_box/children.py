"""Tells the grader which processes this one starts, when they end, and when it does nothing but wait.

`hooks.py` calls `install` when subprocess is imported. Without it the grader could not know that somebody is about to
join: a Python process takes a while until it can say anything itself. Event loops (`ros2 launch` is one) and whoever
waits for a child are told to be waiting, so that simulated time need not stand still for them.
"""

from __future__ import annotations

import os
from typing import Any

from .channel import SOCKET, channel

SOON = 10.0  # [s] a timer of an event loop that is due so soon, such as a TimerAction, is waited for

_waiting = False


def install() -> None:
    """Begin to tell; subprocess has just been imported."""
    import subprocess

    process_class: Any = subprocess.Popen
    start, ended = process_class.__init__, process_class._handle_exitstatus

    def told_start(process: Any, *args: Any, **kwargs: Any) -> None:
        start(process, *args, **kwargs)
        mute = kwargs.get("env") is not None and SOCKET not in kwargs["env"]  # it cannot find the grader
        _tell({"started": {"pid": process.pid, "program": "" if mute else _program(process.pid)}})

    def told_end(process: Any, *args: Any, **kwargs: Any) -> None:
        ended(process, *args, **kwargs)
        _tell({"ended": {"pid": process.pid, "code": process.returncode}})

    def told_wait(method: Any) -> Any:
        def wait(process: Any, *args: Any, **kwargs: Any) -> Any:
            if process.returncode is None:
                _wait_begins()
            return method(process, *args, **kwargs)

        return wait

    process_class.__init__ = told_start
    process_class._handle_exitstatus = told_end
    for name in ("_wait", "_communicate"):
        setattr(process_class, name, told_wait(getattr(process_class, name)))


def install_in_event_loops() -> None:
    """Tell when an event loop is about to sleep; asyncio has just been imported."""
    from asyncio import base_events

    loops: Any = base_events.BaseEventLoop
    once = loops._run_once

    def told_run_once(loop: Any) -> None:
        if not loop._ready and not loop._stopping:
            ready = loop._selector.select(0)
            if ready:
                loop._process_events(ready)
            elif not any(not each._cancelled and each._when < loop.time() + SOON for each in loop._scheduled):
                _wait_begins()
        once(loop)

    loops._run_once = told_run_once


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
    """Name of the program a process runs; empty for a Python that is told to ignore its environment, and so us."""
    try:
        name = os.path.basename(os.readlink(f"/proc/{pid}/exe"))  # noqa: PTH115, PTH119 - pathlib would cost a start
        with open(f"/proc/{pid}/cmdline", "rb") as file:  # noqa: PTH123
            words = file.read().decode(errors="replace").split("\0")[1:]
    except OSError:
        return ""
    if name.startswith("python"):
        for word in words:
            if not word.startswith("-") or word in ("-c", "-m"):
                break
            if not word.startswith("--") and set("IES") & set(word):
                return ""
    return name
