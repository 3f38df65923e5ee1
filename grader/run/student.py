"""The submission's process as the grader sees it: started in its sandbox, read from, and always ended.

Everything it writes comes through two pipes, its progress (see `participant.py`) through a socket. The pipes are
emptied before a progress report is read, so a log line is on record before the tick that produced it is closed.
"""

from __future__ import annotations

import contextlib
import json
import os
import selectors
import signal
import socket
import subprocess
import sys
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

import psutil

from grader.run import participant
from grader.run.sandbox import Sandbox

LONGEST_LINE = 2_000  # [characters] of one line that are kept
MOST_LINES = 20_000  # kept per run; the rest is counted
MOST_READ = 1 << 20  # [bytes] of a pipe, and
MOST_REPORTS = 1_000  # of the socket, taken at once: who writes without end does not keep the grader from going on
SHOWN_FOLDER = b"/submission"  # what the folder of a submission is called in its log
GRACE = 1.5  # [s] between SIGINT, SIGTERM and SIGKILL


@dataclass(frozen=True)
class Endpoint:
    """A publisher or subscription of the student's node."""

    node: str
    kind: str  # publisher | subscription
    topic: str
    type: str
    reliability: str
    durability: str
    matched: int


@dataclass(frozen=True)
class Progress:
    """What the student's process last said about itself. Untrusted."""

    clock: int | None = None  # [ns] simulated time its nodes have seen; None: none follows /clock
    taken: dict[str, int] = field(default_factory=dict)
    published: dict[str, int] = field(default_factory=dict)
    flushes: int = 0  # how often it has asked to be told that everything arrived
    endpoints: tuple[Endpoint, ...] = ()

    @staticmethod
    def parse(data: bytes, before: Progress | None) -> Progress | None:
        """Read one report; None if it is not one. Endpoints it does not mention are as `before`."""
        try:
            raw = json.loads(data)
            clock = raw["clock"]
            return Progress(
                clock=None if clock is None else _count(clock),
                taken={str(k): _count(v) for k, v in raw["taken"].items()},
                published={str(k): _count(v) for k, v in raw["published"].items()},
                flushes=_count(raw["flushes"]),
                endpoints=tuple(_endpoint(e) for e in raw["endpoints"])
                if "endpoints" in raw
                else before.endpoints
                if before
                else (),
            )
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
            return None


def _count(value: Any) -> int:
    if type(value) is not int:
        raise TypeError(f"{value!r} is no count")
    return value


def _endpoint(raw: dict[str, Any]) -> Endpoint:
    endpoint = Endpoint(**raw)
    for each in fields(Endpoint):
        if type(getattr(endpoint, each.name)) is not (int if each.name == "matched" else str):
            raise TypeError(f"{each.name} of an endpoint is {getattr(endpoint, each.name)!r}")
    return endpoint


class Student:
    """One running submission.

    `progress` is its latest report (None before the first), `exit_code` is None while it runs.
    """

    def __init__(self, folder: Path, program: str, sandbox: Sandbox, topics: dict[str, dict[str, str]]) -> None:
        """Start the file `program` of a staged folder with simulated time switched on.

        `topics` says what the grader has an end for: for each kind of endpoint of the student's node (publisher,
        subscription) the topics on which one is waited for, and their ROS types.
        """
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        ours.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        environment = {participant.SOCKET_FD: str(theirs.fileno()), participant.TOPICS: json.dumps(topics)}
        self._children_before = _children()
        self._folder = str(folder).encode()
        command = [sys.executable, "-P", participant.__file__, str(folder / program)]
        command += ["--ros-args", "-p", "use_sim_time:=true"]
        self._process = sandbox.start(command, environment, (theirs.fileno(),))
        theirs.close()
        self._channel = ours
        self._selector = selectors.DefaultSelector()
        self._partial: dict[int, bytes] = {}
        self._pipes = [self._process.stdout, self._process.stderr]
        for pipe in self._pipes:
            os.set_blocking(pipe.fileno(), False)
            self._partial[pipe.fileno()] = b""
            self._selector.register(pipe, selectors.EVENT_READ)
        self._channel.setblocking(False)
        self._selector.register(self._channel, selectors.EVENT_READ)
        self._lines: list[str] = []
        self._line_count = 0
        self.progress: Progress | None = None
        self._answered = 0
        self.exit_code: int | None = None
        self.hid = False  # it closed its end of the socket and lived on

    @property
    def running(self) -> bool:
        """True until the process was seen to end."""
        return self.exit_code is None

    @property
    def dropped_lines(self) -> int:
        """Lines beyond the limit that were read and thrown away."""
        return max(0, self._line_count - MOST_LINES)

    def wait(self, timeout: float) -> bool:
        """Wait at most `timeout` seconds for output, progress or the end; True if something came."""
        if not self.running:
            return False
        ready = self._selector.select(timeout)
        for pipe in self._pipes:
            self._drain(pipe.fileno())
        self._read_progress()
        if self._channel.fileno() not in self._selector.get_map() or self._process.poll() is not None:
            self._reap()
        return bool(ready)

    @property
    def wants_answer(self) -> bool:
        """Whether it waits to be told that everything it published has arrived."""
        return self.progress is not None and self.progress.flushes > self._answered

    def answer(self) -> None:
        """Tell it that everything it published has arrived."""
        if self.progress is not None:
            self._answered = self.progress.flushes
            with contextlib.suppress(OSError):
                self._channel.send(b"arrived")

    def take_lines(self) -> list[str]:
        """Return the lines written since the last call."""
        lines, self._lines = self._lines, []
        return lines

    def _drain(self, fd: int) -> None:
        left = MOST_READ
        while fd in self._partial and left > 0:
            try:
                data = os.read(fd, 1 << 16)
            except BlockingIOError:
                return
            left -= len(data)
            if not data:
                self._selector.unregister(fd)
                rest = self._partial.pop(fd)
                if rest:
                    self._keep(rest)
                return
            *whole, rest = (self._partial[fd] + data).split(b"\n")
            for line in whole:
                self._keep(line)
            self._partial[fd] = rest[: 4 * LONGEST_LINE]

    def _keep(self, line: bytes) -> None:
        self._line_count += 1
        if self._line_count <= MOST_LINES:
            line = line.replace(self._folder, SHOWN_FOLDER)  # where it lies differs between equal runs
            self._lines.append(line.decode(errors="replace")[:LONGEST_LINE])

    def _read_progress(self) -> None:
        for _ in range(MOST_REPORTS):
            if self._channel.fileno() not in self._selector.get_map():
                return
            try:
                data = self._channel.recv(1 << 20)
            except BlockingIOError:
                return
            except ConnectionError:
                data = b""
            if not data:
                self._selector.unregister(self._channel)
                return
            progress = Progress.parse(data, self.progress)
            if progress is not None:
                self.progress = progress

    def _reap(self) -> None:
        """The process has exited, or closed its end of the socket to hide; then it is ended."""
        try:
            self._process.wait(GRACE)
        except subprocess.TimeoutExpired:
            self.hid = True
            self.stop()
        for pipe in self._pipes:
            self._drain(pipe.fileno())
        self._read_progress()
        self.exit_code = self._process.returncode

    def stop(self) -> None:
        """End the process group and every descendant: SIGINT, then SIGTERM, then SIGKILL."""
        with contextlib.suppress(OSError):
            self._channel.shutdown(socket.SHUT_WR)  # nobody is going to answer it any more
        if self._process.poll() is None:
            for escalation in (signal.SIGINT, signal.SIGTERM):
                self._process.signal(escalation)
                try:
                    self._process.wait(GRACE)
                    break
                except subprocess.TimeoutExpired:
                    continue
        self._process.kill()
        self.exit_code = self._process.wait()
        self._sweep()

    def _sweep(self) -> None:
        """Kill what left the process group: as subreaper the grader inherits every orphan."""
        while strays := _children() - self._children_before:
            for stray in strays:
                with contextlib.suppress(psutil.NoSuchProcess):
                    stray.kill()
            psutil.wait_procs(strays, timeout=GRACE)

    def close(self) -> None:
        """End the process if it still runs and close every descriptor."""
        self.stop()
        self._selector.close()
        self._channel.close()
        for pipe in self._pipes:
            pipe.close()


def _children() -> set[psutil.Process]:
    return set(psutil.Process().children(recursive=True))
