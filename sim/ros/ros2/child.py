"""Runs the program of `ros2 run` in the foreground, forwards signals to it, and lets it end with `ros2 run`.

Without a terminal the child has its own process group, and a signal sent to this process is forwarded to that group. On
a terminal the child stays in this process's group, so that Ctrl-C, Ctrl-Z and reading keys work as if it had been
started directly; only signals that the terminal has not delivered are forwarded.
"""

from __future__ import annotations

import os
import shutil
import signal
import sys
from collections.abc import Sequence
from typing import Any

from gz_course.sim.orphan_watch import unwatch, unwatch_process, watch, watch_process

PASSED_ON = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class ChildError(Exception):
    """The program could not be started; the text is one sentence."""


def run_child(command: Sequence[str]) -> int:
    """Run a command until its end; return its exit code, or -n after signal n.

    Raises ChildError if it does not start.
    """
    # Blocked signals are fetched one by one below, so that none is lost, even if the parent has set it to ignored.
    # SIGCHLD must not be ignored, or the child's exit code would be lost.
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    awaited = {*PASSED_ON, signal.SIGCHLD}
    before = signal.pthread_sigmask(signal.SIG_BLOCK, awaited)
    try:
        on_terminal = _on_terminal()
        child = _start(command, own_group=not on_terminal)
        (watch_process if on_terminal else watch)(child)
        try:
            return _wait(child, awaited, on_terminal)
        finally:
            (unwatch_process if on_terminal else unwatch)(child)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _wait(child: int, awaited: set[signal.Signals], on_terminal: bool) -> int:
    """Return the exit code of the child; meanwhile forward signals to it."""
    while True:
        received = signal.sigwaitinfo(awaited)
        if received.si_signo == signal.SIGCHLD:
            pid, status = os.waitpid(child, os.WNOHANG)
            if pid:
                return os.waitstatus_to_exitcode(status)
        elif not on_terminal:
            os.killpg(child, received.si_signo)
        elif received.si_code <= 0:
            # Sent by a process; a signal of the terminal has a positive code and has already reached the child.
            os.kill(child, received.si_signo)


def _on_terminal() -> bool:
    """Return whether this process is in the foreground of a terminal."""
    try:
        return os.tcgetpgrp(sys.__stdin__.fileno()) == os.getpgrp() if sys.__stdin__ else False
    except (OSError, ValueError):
        return False


def _start(command: Sequence[str], own_group: bool) -> int:
    """Start the command with default signal handling; return its process id."""
    program = shutil.which(command[0])
    if program is None:
        raise ChildError(f"there is no program {command[0]!r} to start it with")
    group: dict[str, Any] = {"setpgroup": 0} if own_group else {}
    default = [signal.SIGINT, signal.SIGTERM, signal.SIGCHLD, signal.SIGPIPE]
    sys.stdout.flush()
    try:
        return os.posix_spawn(program, list(command), os.environ, setsigmask=[], setsigdef=default, **group)
    except OSError as error:
        reason = "its first line must be #! and an interpreter" if error.errno == 8 else error.strerror
        raise ChildError(f"{program} does not start: {reason}") from None
