"""The exercise's own node as the grader sees it: in a sandbox beside the submission's, with a connection of its own.

The submission has no way to it but ROS: other files, processes and users, another socket for the lock-step, and a pair
of sockets for its orders and its reports (`agent/course_agent/exercise_node.py`), which nobody else has.
"""

from __future__ import annotations

import contextlib
import json
import os
import socket
import sys
from collections.abc import Mapping
from typing import Any

from gz_course.grader.run.agent.course_agent import channel, exercise_node
from gz_course.grader.run.processes.door import AGENT, SOCKET, listener
from gz_course.grader.run.processes.peer import Peer
from gz_course.grader.run.sandbox import Sandbox
from gz_course.grader.run.sandbox.resource_monitor import descendants

NUMBER = -1  # among the participants: those of the submission count from 0
MOST_REPORTS = 20_000  # that are kept; the rest is counted
MOST_LINES = 1_000  # of its output
MOST_AT_ONCE = 1_000  # reports read in one call


class ExerciseProcess:
    """The running node. `reports` are JSON texts of what it has reported, `lines` its output; both wait to be taken."""

    def __init__(
        self,
        files: Mapping[str, bytes],
        program: str,
        orders: Mapping[str, Any],
        sandbox: Sandbox,
        variables: Mapping[str, str],
    ) -> None:
        """Start `program`, one of the files, which are the exercise's and a submission's packages of interfaces."""
        outside, inside = sandbox.socket_folder
        self.door = listener(outside)
        self.link, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.go, self._tell_to_go = os.pipe()
        folder = sandbox.put_files(files)
        environment = {
            **variables,
            channel.SOCKET: str(inside / SOCKET),
            exercise_node.LINK: str(theirs.fileno()),
            "PYTHONPATH": str(AGENT),
        }
        words = ["course_agent.run_exercise_node", str(folder / program), str(folder)]
        command = [sys.executable, "-P", "-m", *words]
        with theirs:
            self.process = sandbox.start(command, environment, (theirs.fileno(),))
        self.link.setblocking(False)
        self.link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, exercise_node.LARGEST)
        with contextlib.suppress(OSError):  # it has ended already
            self.link.send(json.dumps(orders).encode())
        self.pipes = [self.process.stdout, self.process.stderr]
        for pipe in self.pipes:
            os.set_blocking(pipe.fileno(), False)
        self.reports: list[str] = []
        self.lines: list[str] = []
        self.reported = self._printed = 0
        self.ready = False  # or it has ended before it was
        self.gone = False

    @property
    def exit_code(self) -> int | None:
        """Its exit code, None while it runs."""
        return self.process.poll()

    def holds(self, peer: Peer) -> bool:
        """Whether a connection was made by a living process of this sandbox."""
        return peer.alive and peer.pid in self.members()

    def members(self) -> list[int]:
        """Return the processes of its sandbox."""
        return [self.process.pid, *descendants(self.process.pid)]

    def read(self) -> None:
        """Take what it has reported and printed, without waiting."""
        for _ in range(MOST_AT_ONCE):
            try:
                data = self.link.recv(exercise_node.LARGEST)
            except BlockingIOError:
                break
            except OSError:
                data = b""
            if not data:
                self.gone = True
                break
            if data == exercise_node.READY:
                self._start_the_submission()
                continue
            self.reported += 1
            if self.reported <= MOST_REPORTS:
                self.reports.append(data.decode())
        if self.gone:
            self._start_the_submission()
        for pipe in self.pipes:
            self._print(pipe.fileno())

    def _print(self, pipe: int) -> None:
        with contextlib.suppress(BlockingIOError):
            for line in os.read(pipe, 1 << 16).decode(errors="replace").splitlines():
                self._printed += 1
                if self._printed <= MOST_LINES:
                    self.lines.append(line)

    def _start_the_submission(self) -> None:
        if not self.ready:
            self.ready = True
            os.close(self._tell_to_go)

    def stop(self) -> None:
        """End it."""
        self.process.kill()
        self.process.wait()

    def close(self) -> None:
        """End it and close every descriptor."""
        self.stop()
        self._start_the_submission()
        os.close(self.go)
        self.door.close()
        self.link.close()
        for pipe in self.pipes:
            pipe.close()
