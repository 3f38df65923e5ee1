"""One process of the submission at the other end of a socket: its latest report, and the orders it gets.

`SubmissionProcesses` accepts a connection from every process that imports rclpy (see
`agent/course_agent/import_hooks.py`) and owns these objects. `LockStep` reads `progress` and gives the orders.
"""

from __future__ import annotations

import json
import re
import socket
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from gz_course.grader.run.processes.peer import Peer
from gz_course.grader.run.processes.progress import Progress

LARGEST = 1 << 20  # [bytes] of one message
# A message that nobody receives leaves unseen. Whoever claims to hold messages, and does not send a single one when
# ordered to so often, holds none.
MOST_IN_VAIN = 10_000
MOST_UNSENT = 1_000  # orders kept for a process that reads none: an answer must not be lost among them
MOST_ANSWERS = 100  # kept beyond those; our agent asks one thing at a time
MOST_AT_ONCE = 1_000  # messages taken in one call, so that an endless sender does not stop the grader


class Participant:
    """The connection to a process. `progress` is its latest report (None before the first), `gone` is set at its end.

    `asked(participant, message)` is called with every message that is not a report.
    """

    def __init__(
        self, channel: socket.socket, number: int, asked: Callable[[Participant, dict[str, Any]], None]
    ) -> None:
        self.channel = channel
        self.number = number  # in the order of connecting, from 0
        self.peer = Peer.of(channel)
        self.command: tuple[str, ...] = ()
        self.pid = self.group = 0  # as seen in the sandbox
        self.progress: Progress | None = None
        self.gone = False
        self.joined = False  # whether a report of it had endpoints, which may be gone again
        self.heard: set[str] = set()  # topics to which it has ever subscribed
        self.follows = True  # False: no reports are expected of it
        self.uses_ros = False  # whether it has imported rclpy
        self.waits = False  # whether it only waits, for its children or for events
        self.looking = False  # whether it waits for a service to be found, and has not been idle since
        self.waits_for_log = False  # whether it logs on when told that what it has logged has arrived
        self._logged = 0
        self._asked = asked
        self._answered = 0
        self._released = 0
        self._sent = 0  # messages it had sent when it was last ordered to release one
        self._vain = 0  # orders in a row to which no message left
        self._woken = 0
        self._unsent: deque[bytes] = deque()
        channel.setblocking(False)
        channel.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, LARGEST)

    @property
    def alive(self) -> bool:
        """Whether its process runs and keeps the connection."""
        return not self.gone and self.peer.alive

    @property
    def name(self) -> tuple[str, int]:
        """Key to sort by: its first node, or its command; equal names in the order of connecting."""
        nodes = sorted({e.node for e in self.progress.endpoints}) if self.progress else []
        return (nodes[0] if nodes else " ".join(self.command), self.number)

    @property
    def program(self) -> str:
        """The program's name for people: the file or module that Python runs."""
        words = [word for word in self.command[1:] if word not in ("-m", "-P", "-c")]
        return re.sub(r"^gz_course\.sim\.(bridge|ros|show)\.", "", words[0].rpartition("/")[2]) if words else ""

    @property
    def works(self) -> bool:
        """Whether one of its threads was at work at the last report."""
        return not self.gone and self.progress is not None and not self.progress.idle

    @property
    def starting(self) -> bool:
        """Whether a first report with endpoints is still to come."""
        return self.follows and not (self.joined or self.gone or (self.waits and not self.uses_ros))

    @property
    def waiting_for_release(self) -> bool:
        """Whether it has not reported yet that it carried out a release, or woke a sleeper."""
        if self.gone or self.progress is None:
            return False
        return self.progress.released < self._released or self.progress.woken < self._woken

    @property
    def wants_answer(self) -> bool:
        """Whether it waits for the confirmation that everything it published has arrived."""
        return self.progress is not None and self.progress.flushes > self._answered

    @property
    def logged(self) -> int:
        """How many messages it has sent to /rosout."""
        return max(self._logged, self.progress.logged if self.progress else 0)

    def confirm_log(self) -> None:
        """Confirm that what it has logged has arrived."""
        self.waits_for_log = False
        self.tell({"logs_arrived": True})

    def answer(self) -> None:
        """Confirm that everything it published has arrived. It goes on, and reports again when it waits."""
        if self.progress is not None:
            self._answered = self.progress.flushes
            self.progress = replace(self.progress, idle=False)
            self.tell({"arrived": True})

    def release(self, now: float) -> None:
        """Order it to send one of the messages it holds, at a time [s] of the run."""
        if self.progress is not None:
            sent = sum(self.progress.published.values()) + sum(self.progress.delivered.values())
            self._vain, self._sent = (self._vain + 1 if sent == self._sent else 0), sent
            self._released = self.progress.released + 1
            self.tell({"release": now})

    def wake(self, now_ns: int, every: bool = False) -> None:
        """Order it to let simulated time go on to `now_ns` and to wake the sleeper due first, or every one due."""
        if self.progress is not None:
            self._woken = self.progress.woken + 1
            self.tell({"wake": now_ns} | ({"every": True} if every else {}))

    def tell(self, order: dict[str, Any]) -> None:
        """Send an order or an answer, at once or when there is room for it.

        A process that does not listen reads only while it waits for an answer: what came before fills the socket.
        """
        if len(self._unsent) < MOST_UNSENT + (MOST_ANSWERS if "answer" in order else 0):
            self._unsent.append(json.dumps(order).encode())
        self._send()

    def _send(self) -> None:
        """Send what has been kept, as much as there is room for."""
        while self._unsent:
            try:
                self.channel.send(self._unsent[0])
            except BlockingIOError:
                return
            except OSError:  # nobody will read it
                pass
            self._unsent.popleft()

    def read(self) -> None:
        """Read the messages that have arrived; set `gone` at the end of the connection."""
        self._send()
        for _ in range(MOST_AT_ONCE):
            try:
                data = self.channel.recv(LARGEST)
            except BlockingIOError:
                return
            except OSError:
                data = b""
            if not data:
                self.gone = True
                return
            self._take(data)

    def _take(self, data: bytes) -> None:
        progress = Progress.parse(data, self.progress)
        if progress is not None:
            self.progress = replace(progress, held=0) if self._vain > MOST_IN_VAIN else progress
            self.looking &= not progress.idle
            self.joined |= bool(progress.endpoints)
            self.heard.update(e.topic for e in progress.endpoints if e.kind == "subscription")
            return
        try:
            message = json.loads(data)
            if hello := message.get("hello"):
                self._meet(hello)
            if "logged" in message:
                self._logged, self.waits_for_log = int(message["logged"]), True
            self.uses_ros |= "ros" in message
            self.looking |= "looking" in message
            if "time" not in message:  # who asks for the time goes on as before
                self.waits = "waiting" in message
            self._asked(self, message)
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError, OverflowError, OSError):
            return  # not from our agent: an infinite number, or a name that cannot be a file's

    def _meet(self, hello: dict[str, Any]) -> None:
        """Note who it is: as the kernel shows it, or as it says itself if it has ended meanwhile."""
        self.pid, self.group = int(hello["pid"]), int(hello["group"])
        self.command = tuple(str(word) for word in hello["command"])
        pid, group = self.peer.inner
        if self.peer.alive:
            self.pid, self.group, self.command = pid, group, self.peer.command
        hello |= {"pid": self.pid, "group": self.group}

    def close(self) -> None:
        self.channel.close()
