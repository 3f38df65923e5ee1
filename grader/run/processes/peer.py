"""Who is at the other end of a connection, as the kernel knows it: nothing a process says of itself is used here.

The kernel names the process that connected (SO_PEERCRED), in the grader's own numbering, and /proc shows what that
process is: its parents, its executable, its command line, its number in the box.

Source: unix(7), "SO_PEERCRED"; proc(5), `/proc/pid/stat` and `/proc/pid/status`; pid_namespaces(7).
"""

from __future__ import annotations

import os
import socket
import struct
import sys
import time
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from gz_course.grader.run.sandbox.resource_monitor import descendants

CREDENTIALS = struct.Struct("3i")  # pid, uid, gid
MOST_ANCESTORS = 1_000
MOST_WORDS = 100  # of a command line
WITH_VALUE = ("-W", "-X", "--check-hash-based-pycs")  # options of Python that take the next word


@dataclass(frozen=True)
class Peer:
    """A process, by its number in the grader's namespace and its start, so that no later process is taken for it."""

    pid: int
    started: int  # [ticks] since the machine has started; -1: it had ended before anybody looked

    @staticmethod
    def of(channel: socket.socket) -> Peer:
        """Return the process that has made a connection."""
        pid = CREDENTIALS.unpack(channel.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, CREDENTIALS.size))[0]
        return Peer.look(pid)

    @staticmethod
    def look(pid: int) -> Peer:
        """Return the process that has a number now."""
        stat = _stat(pid)
        return Peer(pid, int(stat[19]) if stat else -1)

    @property
    def alive(self) -> bool:
        """Whether it still runs."""
        return self.started >= 0 and Peer.look(self.pid) == self

    @property
    def age(self) -> float:
        """Time since its start [s]."""
        return time.clock_gettime(time.CLOCK_BOOTTIME) - self.started / os.sysconf("SC_CLK_TCK")

    @property
    def inner(self) -> tuple[int, int]:
        """Its number and that of its process group, in the innermost namespace."""
        return _inner(self.pid, "NSpid:"), _inner(self.pid, "NSpgid:")

    @property
    def command(self) -> tuple[str, ...]:
        """The words of its command line."""
        try:
            words = Path(f"/proc/{self.pid}/cmdline").read_bytes().removesuffix(b"\0").split(b"\0")
        except OSError:
            return ()
        return tuple(word.decode(errors="replace") for word in words[:MOST_WORDS])

    @property
    def program(self) -> tuple[str, tuple[str, ...]]:
        """The program of the course that it runs, with its arguments; empty if it runs another, or has ended.

        That is a file beside the grader's Python, by its name (`gz`), or a module (`gz_course.sim...`).
        """
        command = self.command
        return _program(command) if self.alive and _runs_our_python(self.pid) else ("", ())


class BoxProcesses:
    """The processes of one box: those below `root`, and where `walled` is False, orphans that Linux gave the grader.

    `before` are the grader's own children, which had been there before the box was made.
    """

    def __init__(self, root: int, walled: bool, before: frozenset[int]) -> None:
        self._root, self._walled, self._before = root, walled, before

    def holds(self, peer: Peer) -> bool:
        """Whether a process is in the box. Where nobody else can reach in, one that has ended was."""
        if not peer.alive:
            return self._walled and peer.started < 0
        me, pid = os.getpid(), peer.pid
        for _ in range(MOST_ANCESTORS):
            if pid == self._root:
                return True
            stat = _stat(pid)
            if stat is None or pid in self._before:
                return False
            parent = int(stat[1])
            if parent == me:
                return not self._walled
            pid = parent
        return False

    def age(self, inner: int) -> float | None:
        """Return how long the process with a number in the box has run [s]; None if there is none."""
        if not self._walled:
            peer = Peer.look(inner)
            return peer.age if self.holds(peer) else None
        for pid in descendants(self._root):
            if _inner(pid, "NSpid:") == inner:
                peer = Peer.look(pid)
                return peer.age if peer.started >= 0 else None
        return None


def _stat(pid: int) -> list[bytes] | None:
    """Return the fields of /proc/pid/stat from the state on; None if there is no such process, or it has ended."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_bytes().rpartition(b")")[2].split()
    except OSError:
        return None
    return None if fields[0] in (b"Z", b"X") else fields


def _inner(pid: int, name: str) -> int:
    try:
        for line in Path(f"/proc/{pid}/status").read_text().splitlines():
            if line.startswith(name):
                return int(line.split()[-1])
    except OSError:
        pass
    return 0


def _runs_our_python(pid: int) -> bool:
    """Whether a process executes the file that the grader's own Python is; its path in the box may be another."""
    try:
        there, here = Path(f"/proc/{pid}/exe").stat(), Path("/proc/self/exe").stat()
    except OSError:
        return False
    return (there.st_dev, there.st_ino) == (here.st_dev, here.st_ino)


def _program(command: tuple[str, ...]) -> tuple[str, tuple[str, ...]]:
    words, safe = list(command[1:]), False
    while words and words[0].startswith("-"):
        option = words.pop(0)
        if option == "-c" or not words:
            return "", ()
        if option == "-m":
            ours = safe and words[0].startswith("gz_course.sim.")
            return (words[0], tuple(words[1:])) if ours else ("", ())
        safe |= option in ("-P", "-I")  # no file of the current folder stands for a module
        if option in WITH_VALUE:
            words.pop(0)
    if words and os.path.dirname(words[0]) in _folders():  # noqa: PTH120 - as it is written, not as it resolves
        return os.path.basename(words[0]), tuple(words[1:])  # noqa: PTH119
    return "", ()


@cache
def _folders() -> frozenset[str]:
    """Return the folder of the course's programs, by each of its names."""
    return frozenset({str(Path(sys.executable).parent), str(Path(sys.prefix, "bin"))})
