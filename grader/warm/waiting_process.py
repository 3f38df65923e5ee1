"""The helper: waits with all imports done, forks a grading for each order, and ends after a time without one.

A grading is a process of its own with the folder, streams, environment and arguments of the command that has asked for
it. It outlives the helper, and ends with the command: the kernel sends it SIGTERM as soon as the connection is closed.

Source: fcntl(2) (F_SETSIG, F_SETOWN, O_ASYNC), unix(7), flock(2)
"""

from __future__ import annotations

import contextlib
import fcntl
import io
import os
import select
import signal
import socket
import sys
import time
from collections.abc import Callable
from typing import Any, NoReturn, TextIO

from gz_course.grader.process.forking import fork
from gz_course.grader.warm.command import become_course
from gz_course.grader.warm.imports import load, wait_for_rest
from gz_course.grader.warm.order import is_own, receive_order, send_answer
from gz_course.grader.warm.place import within

F_SETSIG = 10
LOCK = ".lock"  # behind the name of a socket: the file that its helper keeps locked
ORDERED = 5.0  # [s] within which an order has come
LOOK = 30.0  # [s] between two looks whether the socket is still there


def main() -> None:
    """Be the helper: the arguments are an open folder, the socket's name in it, and the longest idle time [s]."""
    folder, name, idle = int(sys.argv[1]), sys.argv[2], float(sys.argv[3])
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for gradings
    if (lock := _claimed(folder, name)) is None:  # there is one already
        return
    _sweep(folder, name)
    load()
    with _door(folder, name) as door:
        number = _number(folder, name)
        try:
            _serve(door, (folder, lock), idle, lambda: _number(folder, name) == number)
        finally:
            if _number(folder, name) == number:
                _remove(folder, name)
                with contextlib.suppress(OSError):  # others are in it
                    within(folder, ".").resolve().rmdir()


def _claimed(folder: int, name: str) -> int | None:
    """Return a descriptor that keeps a name to this process, None if another has it."""
    lock = os.open(within(folder, f"{name}{LOCK}"), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(lock)
        return None
    return lock


def _sweep(folder: int, own: str) -> None:
    """Remove what helpers left that were killed."""
    for path in within(folder, ".").glob(f"*{LOCK}"):
        name = path.name.removesuffix(LOCK)
        if name != own and (lock := _claimed(folder, name)) is not None:
            _remove(folder, name)
            os.close(lock)


def _remove(folder: int, name: str) -> None:
    for each in (name, f"{name}{LOCK}"):
        within(folder, each).unlink(missing_ok=True)


def _number(folder: int, name: str) -> int | None:
    """Return the number by which the file system knows a file, None if it is gone."""
    with contextlib.suppress(OSError):
        return within(folder, name).stat().st_ino
    return None


def _door(folder: int, name: str) -> socket.socket:
    """Return a listening socket, which has its name only when it listens."""
    door = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    fresh = within(folder, f"{name}.new")
    fresh.unlink(missing_ok=True)
    door.bind(str(fresh))
    door.listen()
    fresh.rename(within(folder, name))
    return door


def _serve(door: socket.socket, apart: tuple[int, ...], idle: float, in_place: Callable[[], bool]) -> None:
    """Fork a grading for each order; `apart` are descriptors that gradings do not keep."""
    poll = select.poll()
    poll.register(door, select.POLLIN)
    last = time.monotonic()
    while (left := last + idle - time.monotonic()) > 0:
        if not poll.poll(min(left, LOOK) * 1000):
            if not in_place():
                return
            continue
        connection = door.accept()[0]
        with connection:
            connection.settimeout(ORDERED)
            try:
                if not is_own(connection):
                    continue
                order, descriptors = receive_order(connection)
            except (OSError, ValueError):
                continue
            wait_for_rest()
            if fork() == 0:
                door.close()
                for each in apart:
                    os.close(each)
                _grade(connection, order, descriptors)
            for each in descriptors:
                os.close(each)
        last = time.monotonic()


def _grade(connection: socket.socket, order: dict[str, Any], descriptors: list[int]) -> NoReturn:
    """Become the command that has sent the order; tell it the exit code."""

    def take_over() -> None:
        os.setsid()
        for number in (signal.SIGTERM, signal.SIGCHLD):
            signal.signal(number, signal.SIG_DFL)
        folder, *streams = descriptors
        os.fchdir(folder)
        for descriptor, stream in enumerate(streams):
            os.dup2(stream, descriptor)
        for each in descriptors:
            os.close(each)
        _renew_streams()
        os.umask(order["umask"])
        send_answer(connection, pid=os.getpid())
        _end_with(connection)

    def tell(code: int) -> None:
        fcntl.fcntl(connection, fcntl.F_SETFL, fcntl.fcntl(connection, fcntl.F_GETFL) & ~os.O_ASYNC)
        send_answer(connection, exit=code)

    arguments = order["arguments"]
    become_course(take_over, arguments, order["environment"], arguments, tell)


def _end_with(connection: socket.socket) -> None:
    """Have the kernel send SIGTERM to this process when the other end is closed; nothing else comes from there."""
    connection.settimeout(None)
    fcntl.fcntl(connection, F_SETSIG, signal.SIGTERM)
    fcntl.fcntl(connection, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(connection, fcntl.F_SETFL, fcntl.fcntl(connection, fcntl.F_GETFL) | os.O_ASYNC)
    look = select.poll()
    look.register(connection, select.POLLIN)
    if look.poll(0):  # it was closed before
        sys.exit(128 + signal.SIGTERM)


def _renew_streams() -> None:
    """Make Python's streams anew: those of the helper lead nowhere, and are buffered as a file's are."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        renewed = _stream(number, "w" if number else "r", getattr(sys, name))
        setattr(sys, name, renewed)
        setattr(sys, f"__{name}__", renewed)


def _stream(number: int, mode: str, before: TextIO) -> TextIO:
    made = open(number, f"{mode}b", closefd=False)  # noqa: SIM115
    by_lines = mode == "w" and (number == 2 or os.isatty(number))
    return io.TextIOWrapper(made, encoding=before.encoding, errors=before.errors, line_buffering=by_lines)


if __name__ == "__main__":
    main()
