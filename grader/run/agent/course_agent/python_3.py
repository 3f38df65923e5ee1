"""All patches of the standard library: they report which processes this one starts, and when it only waits.

`import_hooks.py` calls `install_subprocess` and `install_asyncio` when those modules are imported. A new Python process
needs a while until it can report anything, so its parent announces it. Event loops (`ros2 launch` is one) and processes
that wait for a child are reported as waiting, so that simulated time does not stand still for them.
"""

from __future__ import annotations

import os
from typing import Any

from .channel import SOCKET, channel
from .self_check import Reliance, misfits

SOON = 10.0  # [s] a timer of an event loop that is due within this time, such as a TimerAction, is waited for
# Source: subprocess.py and asyncio/ of CPython 3.11 to 3.14.
SUBPROCESS: dict[str, Reliance] = {
    "subprocess:Popen.__init__": ("", "returncode pid"),
    "subprocess:Popen._handle_exitstatus": ("", "returncode"),
    "subprocess:Popen._wait": ("self timeout", ""),
    "subprocess:Popen._communicate": ("self input endtime orig_timeout", ""),
}
ASYNCIO: dict[str, Reliance] = {
    "asyncio.base_events:BaseEventLoop._run_once": ("self", "_scheduled _ready _stopping _selector _process_events"),
    "asyncio.events:TimerHandle.__init__": ("", "_when"),
    "asyncio.events:Handle.__init__": ("", "_cancelled"),
}

_waiting = False


def install_subprocess() -> None:
    """Start to report which processes start and end. Raises ImportError if `subprocess` is not as expected."""
    import subprocess

    _check(SUBPROCESS)
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


def install_asyncio() -> None:
    """Start to report when an event loop is about to wait. Raises ImportError if `asyncio` is not as expected."""
    from asyncio import base_events

    _check(ASYNCIO)
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
