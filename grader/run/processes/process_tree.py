"""The processes a submission has started, as far as it tells: which are about to join, and which have just left.

Fed by `SubmissionProcesses` with what `agent/course_agent/python_3.py` says. A process that is starting up cannot say
anything yet, and what its parent does about its end takes a moment; simulated time stands still meanwhile.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

START_UP = 10.0  # [s] of wall time for a process to say hello, and then to have a node that spins
# [s] for each state: until it says hello (a shell may become a Python), and until its parent notices that it has ended
PATIENCE = {"starting": START_UP, "shell": 3.0, "left": 1.0}
MOST_CHILDREN = 1_000
SHELLS = ("sh", "dash", "bash", "env")


@dataclass
class StartedProcess:
    """One process. `state` is `starting`, `shell`, `here` (it said hello), `left`, `ended`, `silent` (never speaks)."""

    pid: int  # as it is seen in the box
    state: str
    since: float  # [s] monotonic
    code: int | None = None


class ProcessTree:
    """All processes the submission has told of, by their number in the box."""

    def __init__(self) -> None:
        self._processes: dict[int, StartedProcess] = {}

    def hear(self, message: dict[str, Any]) -> None:
        """Take in a message. Raises TypeError, KeyError or ValueError if it is malformed."""
        now = time.monotonic()
        if (started := message.get("started")) and len(self._processes) < MOST_CHILDREN:
            program = str(started["program"])
            state = "shell" if program in SHELLS else "starting" if program.startswith("python") else "silent"
            self._processes[int(started["pid"])] = StartedProcess(int(started["pid"]), state, now)
        elif ended := message.get("ended"):
            child = self._processes.get(int(ended["pid"]))
            if child is not None:
                child.state, child.code = "ended", int(ended["code"])
        elif hello := message.get("hello"):
            for pid in (int(hello["pid"]), int(hello["group"])):
                if (child := self._processes.get(pid)) and child.state in PATIENCE:
                    child.state = "here"

    def leave(self, pid: int) -> None:
        """Note that a process has closed its socket: it ends, or becomes another program."""
        child = self._processes.get(pid)
        if child is not None and child.state == "here":
            child.state, child.since = "left", time.monotonic()

    def codes(self) -> dict[int, int]:
        """Return the exit code by process number, of those that have ended."""
        return {child.pid: child.code for child in self._processes.values() if child.code is not None}

    @property
    def changing(self) -> bool:
        """Whether a process is about to say hello, or its parent about to notice its end."""
        now = time.monotonic()
        return any(now < child.since + PATIENCE.get(child.state, 0.0) for child in self._processes.values())
