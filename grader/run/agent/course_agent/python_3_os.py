"""Patches of `os` and `signal`: processes that are started, and waits for them and for signals, without `subprocess`.

`ros2 run` is such a program: it starts another one and waits for signals. As with `subprocess` (`python_3.py`), the
grader learns of the new process at once, so that simulated time stands still until it is there, and of the wait, so
that it does not stand still for who only waits. `import_hooks.py` calls `install` at every start of Python; the rest of
the agent is imported when one of these functions is called.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from typing import Any

SPAWN = ("posix_spawn", "posix_spawnp")
SIGNALS = ("pause", "sigtimedwait", "sigwait", "sigwaitinfo")  # calls that wait for a signal
KNOWN = "subprocess"  # the module whose calls are reported already

_load: Callable[[], Any]


def install(load: Callable[[], Any]) -> None:
    """Start to report what this process starts and waits for. `load` returns the module that reports."""
    global _load
    _load = load
    for name in SPAWN:
        if (spawn := getattr(os, name, None)) is not None:
            setattr(os, name, _told_spawn(spawn))
    system: Any = os
    system.waitpid = _told_waitpid(os.waitpid)
    system.wait = _told_wait(system.waitpid)
    for name in SIGNALS:
        setattr(signal, name, _told_signal_wait(getattr(signal, name)))


def _told_spawn(spawn: Callable[..., int]) -> Callable[..., int]:
    def told(path: Any, argv: Any, env: Any, *args: Any, **kwargs: Any) -> int:
        pid = spawn(path, argv, env, *args, **kwargs)
        caller = sys._getframe(1).f_globals.get("__name__", "")
        if caller != KNOWN:
            _load().tell_start(pid, env, caller)
        return pid

    return told


def _told_waitpid(waitpid: Callable[[int, int], tuple[int, int]]) -> Callable[[int, int], tuple[int, int]]:
    def told(pid: int, options: int, /) -> tuple[int, int]:
        if sys._getframe(1).f_globals.get("__name__", "") == KNOWN:
            return waitpid(pid, options)
        ended, status = waitpid(pid, options | os.WNOHANG)
        if not ended and not options & os.WNOHANG:
            with _load().waiting_for_child():
                ended, status = waitpid(pid, options)
        if ended and (os.WIFEXITED(status) or os.WIFSIGNALED(status)):
            _load().tell_end(ended, os.waitstatus_to_exitcode(status))
        return ended, status

    return told


def _told_wait(waitpid: Callable[[int, int], tuple[int, int]]) -> Callable[[], tuple[int, int]]:
    def told() -> tuple[int, int]:
        return waitpid(-1, 0)

    return told


def _told_signal_wait(wait: Callable[..., Any]) -> Callable[..., Any]:
    def told(*args: Any) -> Any:
        with _load().waiting():
            return wait(*args)

    return told
