"""The process from which the gradings of a class are forked: it has done the imports, and does nothing else.

`forked_process.py` runs it as `python -m gz_course.grader.whole_class.fork_server PARENT DESCRIPTOR ROOM` and sends an
order for each grading: folder, arguments of `course`, environment. Each grading is a process of its own, which keeps
modules and nothing else: this process never reads a submission, and what a grading does stays in it.

A grading is a child of PARENT, not of this process, so that it goes on should this process be killed: it is forked by a
process in between, which ends at once; PARENT is a subreaper. Only then the grading begins, as it asks for a signal at
the end of its parent.

Source: fork(2), prctl(2) (PR_SET_CHILD_SUBREAPER, PR_SET_PDEATHSIG)
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import os
import signal
import sys
from multiprocessing.connection import Connection
from typing import Any, NoReturn

from gz_course.grader.process.forking import fork
from gz_course.grader.warm.command import become_course
from gz_course.grader.warm.imports import load, wait_for_rest

PR_SET_PDEATHSIG = 1


def main() -> NoReturn:
    """Fork gradings until the starter closes its end."""
    parent, channel = int(sys.argv[1]), Connection(int(sys.argv[2]))
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the starter, which ends the gradings
    try:
        load()
        channel.send_bytes(_answer())
        while True:
            order = json.loads(channel.recv_bytes())
            if fork_for(parent, channel):
                grade(order)
    except (EOFError, ConnectionError):
        os._exit(0)
    except Exception as error:
        with contextlib.suppress(OSError):
            channel.send_bytes(_answer(error=f"{type(error).__name__}: {error}"))
        os._exit(1)


def _answer(**content: Any) -> bytes:
    return json.dumps(content).encode()


def fork_for(parent: int, channel: Connection) -> bool:
    """Fork a new child of `parent` and tell its number; return True in the child, False here."""
    wait_for_rest()
    told, tell = os.pipe()
    wait, begin = os.pipe()
    between = fork()
    if between == 0:
        _in_between(parent, channel, told, tell, wait, begin)
        return True
    os.close(tell)
    os.close(wait)
    number = os.read(told, 100)
    os.waitpid(between, 0)
    if number.isdigit():
        channel.send_bytes(_answer(pid=int(number)))
        os.write(begin, b"+")  # after it is known, and has got its parent
    else:
        channel.send_bytes(_answer(error=number.decode() or "a fork ended at once"))
    os.close(told)
    os.close(begin)
    return False


def _in_between(parent: int, channel: Connection, told: int, tell: int, wait: int, begin: int) -> None:
    """Fork once more and end; return in the child when it has got its parent."""
    try:
        os.close(told)
        os.close(begin)
        if fork():
            os._exit(0)
        os.setsid()
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        channel.close()
        os.write(tell, b"%d" % os.getpid())  # the starter may send signals from now on
        os.close(tell)
        if not os.read(wait, 1):
            os._exit(3)
        os.close(wait)
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)  # `course` closes everything on SIGTERM
        if os.getppid() != parent:
            os._exit(3)
    except OSError as error:
        with contextlib.suppress(OSError):
            os.write(tell, str(error.strerror).encode())
        os._exit(3)


def grade(order: dict[str, Any]) -> NoReturn:
    """Become `course` with the folder, environment and arguments of an order; errors go to the folder's `stderr`."""

    def take_over() -> None:
        os.chdir(order["folder"])
        errors = os.open("stderr", os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        os.dup2(errors, 2)
        os.close(errors)

    arguments = order["arguments"]
    become_course(take_over, arguments, order["environment"], [*arguments[:1], order["folder"]])


if __name__ == "__main__":
    main()
