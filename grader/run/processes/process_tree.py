"""The processes that a submission reports to have started: those about to connect, and those that have just ended.

`SubmissionProcesses` passes on the reports of `agent/course_agent/python_3.py`. Simulated time stands still while a
process starts up, which cannot report anything yet, and while a parent reacts to the end of its child.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

START_UP = 10.0  # [s] for a process to say hello, and then to have a node that spins
# [s] for each state: until it says hello (a shell may become a Python), and until its parent notices that it has ended
PATIENCE = {"starting": START_UP, "shell": 3.0, "left": 1.0}
MOST_CHILDREN = 1_000
SAME = 0.05  # [s] by which the start of a process is known
SHELLS = ("sh", "dash", "bash", "env")


@dataclass
class StartedProcess:
    """One process. `state`: `starting`, `shell`, `here` (it said hello), `left`, `ended`, `silent` (not Python)."""

    pid: int  # as seen in the sandbox
    state: str
    since: float  # [s]
    code: int | None = None
    in_vain: bool = False  # whether it was waited for, and never said hello
    ours: bool = True  # whether code of the course has started it, such as an action of a launch
    started: float = field(default_factory=time.monotonic)  # [s] of wall time


class ProcessTree:
    """All processes that the submission has reported, by their process id in the sandbox; `now()` is the time [s].

    `age(pid)` [s] of wall time is that of a process in the box, None if there is none: a report alone holds nobody up.
    `delayed()` [s] is for how long `now()` has stood still, which makes a process look too old to have just started.
    """

    def __init__(
        self,
        age: Callable[[int], float | None],
        now: Callable[[], float] = time.monotonic,
        delayed: Callable[[], float] = lambda: 0.0,
    ) -> None:
        self._age = age
        self._now = now
        self._delayed = delayed
        self._processes: dict[int, StartedProcess] = {}

    def hear(self, message: dict[str, Any]) -> None:
        """Update from a message. Raises TypeError, KeyError or ValueError if it is malformed."""
        if (started := message.get("started")) and len(self._processes) < MOST_CHILDREN:
            self._start(int(started["pid"]), str(started["program"]), bool(started.get("ours", True)))
        elif ended := message.get("ended"):
            child = self._processes.get(int(ended["pid"]))
            if child is not None and not self._lives(child):
                child.in_vain |= child.state in ("starting", "shell")
                child.state, child.code = "ended", int(ended["code"])
        elif hello := message.get("hello"):
            for pid in (int(hello["pid"]), int(hello["group"])):
                if (child := self._processes.get(pid)) and child.state in PATIENCE:
                    child.state = "here"

    def _start(self, pid: int, program: str, ours: bool) -> None:
        """Note a process that was started; wait for one that exists, and only once."""
        age, before = self._age(pid), self._processes.get(pid)
        if before is not None and self._lives(before):
            return
        state = "shell" if program in SHELLS else "starting" if program.startswith("python") else "silent"
        waited = age is not None and age < START_UP + self._delayed()
        self._processes[pid] = StartedProcess(pid, state if waited else "silent", self._now(), ours=ours)

    def _lives(self, child: StartedProcess) -> bool:
        """Whether a process of the tree still exists; a younger one may have got its number."""
        age = self._age(child.pid) if child.state != "ended" else None
        return age is not None and age > time.monotonic() - child.started - SAME

    def knows(self, pid: int) -> bool:
        """Whether a process of the submission has said that it started this one, which has not ended for its parent."""
        child = self._processes.get(pid)
        return child is not None and child.state != "ended"

    def is_ours(self, pid: int) -> bool:
        """Whether no code of the submission has said that it started this process itself."""
        child = self._processes.get(pid)
        return child is None or child.ours

    def leave(self, pid: int) -> None:
        """Note that a process has closed its socket: it ends, or executes another program."""
        child = self._processes.get(pid)
        if child is not None and child.state == "here":
            child.state, child.since = "left", self._now()

    def codes(self) -> dict[int, int]:
        """Return the exit codes of the processes that have ended, by process id."""
        return {child.pid: child.code for child in self._processes.values() if child.code is not None}

    @property
    def changing(self) -> bool:
        """Whether a process is about to say hello, or its parent about to notice its end."""
        waiting = [child for child in self._processes.values() if child.state in PATIENCE and not child.in_vain]
        now = self._now() if waiting else 0.0
        for child in waiting:
            child.in_vain |= child.state != "left" and now >= child.since + PATIENCE[child.state]
        return any(now < child.since + PATIENCE[child.state] for child in waiting)

    @property
    def in_vain(self) -> int:
        """How many processes were waited for that never said hello."""
        return sum(child.in_vain for child in self._processes.values())
