"""The command's side: `course grade` in a terminal is done by a fork of the helper, if there is one.

Nothing heavy is imported here. Without a helper the command does all itself, and then starts one for the next time.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import socket
import sys
from collections.abc import Callable, Iterator
from types import FrameType

from gz_course.grader.process.forking import fork
from gz_course.grader.warm.order import is_own, send_order
from gz_course.grader.warm.place import open_folder, socket_name, within

NO_HELPER = "--no-helper"
IDLE = 600.0  # [s] after which a helper ends
BEGINS = 20.0  # [s] within which a helper has begun a grading
FORWARDED = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
ROOM = " " * 200  # in the command line, where a grading shows what it does
_READ = 1 << 12


def wants_helper(arguments: list[str]) -> bool:
    """Tell whether a command is a grading that somebody waits for at a terminal."""
    return arguments[:1] == ["grade"] and NO_HELPER not in arguments and os.isatty(1) and os.isatty(2)


def run(arguments: list[str], itself: Callable[[], None]) -> None:
    """Grade by the helper; without one call `itself`, which ends with SystemExit, and start one when it has graded."""
    try:
        folder, name = open_folder(), socket_name()
    except OSError as error:
        _say(f"no helper is used, so each grading begins with its imports: {error.filename}: {error.strerror}")
        itself()
        return
    code = graded(folder, name, arguments)
    if code is not None:
        sys.exit(code)
    start = prepared(folder, name)
    try:
        itself()
    except SystemExit as end:
        if end.code in (0, 1):  # it has graded
            start()
        raise


def graded(folder: int, name: str, arguments: list[str]) -> int | None:
    """Return the exit code of a grading by the helper, None if there is none, or none that comes to an end."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection:
        connection.settimeout(BEGINS)
        try:
            connection.connect(str(within(folder, name)))
            if not is_own(connection):
                return None
            grading = _Grading(connection)
            with grading.hearing():
                send_order(connection, arguments)
                return grading.exit_code()
        except OSError:
            return None


class _Grading:
    """A grading in a fork of the helper, at the other end of a connection."""

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self._pid: int | None = None
        self._waiting: list[int] = []  # signals that came before the number of the process

    @contextlib.contextmanager
    def hearing(self) -> Iterator[None]:
        """Pass on, for the time of a `with`, the signals that would end this process."""
        before = [signal.getsignal(each) for each in FORWARDED]
        for each, handler in zip(FORWARDED, before, strict=True):
            if handler is not signal.SIG_IGN:
                signal.signal(each, self._pass_on)
        try:
            yield
        finally:
            for each, handler in zip(FORWARDED, before, strict=True):
                signal.signal(each, handler)

    def _pass_on(self, number: int, _: FrameType | None) -> None:
        if self._pid is None:
            self._waiting.append(number)
            return
        with contextlib.suppress(ProcessLookupError):
            os.kill(self._pid, number)

    def exit_code(self) -> int | None:
        """Wait for the end of the grading."""
        code, data = None, b""
        while part := self._connection.recv(_READ):
            data += part
            *lines, data = data.split(b"\n")
            for line in lines:
                told = json.loads(line)
                code = told.get("exit", code)
                if "pid" in told:
                    self._begun(told["pid"])
        if code is None and self._pid is not None:
            _say("the helper's grading was ended; it is done again without the helper")
        return code

    def _begun(self, pid: int) -> None:
        self._connection.settimeout(None)
        self._pid = pid
        for number in self._waiting:
            self._pass_on(number, None)


def prepared(folder: int, name: str, idle: float = IDLE) -> Callable[[], None]:
    """Fork what will become the helper, before this process has threads or enters namespaces; return what starts it.

    It is nobody's child and in no session of a terminal. Until it is started it waits, and ends with this process.
    """
    wait, begin = os.pipe()
    if (between := fork()) == 0:
        try:
            os.setsid()
            if fork():
                os._exit(0)
            os.close(begin)
            _become_helper(wait, folder, name, idle)
        finally:
            os._exit(1)
    os.waitpid(between, 0)
    os.close(wait)

    def start() -> None:
        with contextlib.suppress(OSError):
            os.write(begin, b"+")

    return start


def _become_helper(wait: int, folder: int, name: str, idle: float) -> None:
    nothing = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(nothing, stream)
    os.chdir("/")
    for each in FORWARDED:
        signal.signal(each, signal.SIG_DFL)
    if os.read(wait, 1):
        os.set_inheritable(folder, True)
        words = ["-P", "-m", "gz_course.grader.warm.waiting_process", str(folder), name, str(idle), ROOM]
        os.execv(sys.executable, [sys.executable, *words])


def _say(sentence: str) -> None:
    print(f"course: {sentence}", file=sys.stderr)
