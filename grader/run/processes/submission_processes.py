"""The submission's processes as the grader sees them: started in a sandbox, read from, and always ended.

Everything they write comes through two pipes, the reports of each (see `participant.py`) through a socket of its own.
The pipes are emptied before a report is read, so a log line is recorded before the tick that produced it is closed.
"""

from __future__ import annotations

import contextlib
import json
import os
import selectors
import signal
import socket
import subprocess
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import psutil

from gz_course.grader.run.agent.course_agent import channel, executor_monitor
from gz_course.grader.run.agent.course_agent.run_package import GO
from gz_course.grader.run.fair_clock import FairClock, Patience
from gz_course.grader.run.processes.door import AGENT, MOST_PARTICIPANTS, SOCKET, listener
from gz_course.grader.run.processes.exercise_process import NUMBER, ExerciseProcess
from gz_course.grader.run.processes.participant import Participant
from gz_course.grader.run.processes.peer import BoxProcesses, Peer
from gz_course.grader.run.processes.process_tree import ProcessTree
from gz_course.grader.run.processes.progress import Endpoint
from gz_course.grader.run.processes.submission_log import SubmissionLog
from gz_course.grader.run.sandbox import Sandbox
from gz_course.grader.run.sandbox.resource_monitor import descendants
from gz_course.grader.run.watchdog import cpu_seconds, is_stopped

LOOK_AGAIN = 0.1  # [s] between two looks at the clock while the end is awaited
MOST_IN_VAIN = 30  # processes that are waited for and never take part
GRACE = 1.5  # [s] between SIGINT, SIGTERM and SIGKILL


class SubmissionProcesses:
    """One running submission: a process and everything it starts.

    `exit_code` is that of the first process, None while it runs. `participants` are the processes that have said hello,
    the first process first; the exercise's own node (`beside`), if there is one, takes part among them.
    `asked(participant, message)` gets their requests. `clock` is that of all of them and of the grader;
    `clock_but_mine` goes on while only the thread that has started them waits for a processor.
    """

    def __init__(
        self,
        command: Sequence[str],
        sandbox: Sandbox,
        topics: dict[str, dict[str, str]],
        environment: Mapping[str, str] | None = None,
        asked: Callable[[Participant, dict[str, Any]], None] | None = None,
        shown: str = "",
        beside: ExerciseProcess | None = None,
    ) -> None:
        """Start a command in a sandbox.

        `topics` are the grader's endpoints: for each kind of endpoint of a student's node (publisher, subscription) the
        topics on which the grader has the opposite one, and their ROS types. The folder `shown` appears as
        `/submission` in the log.
        """
        outside, inside = sandbox.socket_folder
        self._listener = listener(outside)
        variables = {
            channel.SOCKET: str(inside / SOCKET),
            executor_monitor.TOPICS: json.dumps(topics),
            "PYTHONPATH": str(AGENT),
            **(environment or {}),
            **({GO: str(beside.go)} if beside is not None else {}),
        }
        self.beside = beside
        self.asked = asked or _unasked
        self._children_before = _children()
        self._apart = frozenset(each.pid for each in self._children_before)
        self._process = sandbox.start(list(command), variables, () if beside is None else (beside.go,))
        self._selector = selectors.DefaultSelector()
        self.log = SubmissionLog((self._process.stdout, self._process.stderr), self._selector, shown)
        for each in (self._listener, *(() if beside is None else (beside.door, beside.link))):
            self._selector.register(each, selectors.EVENT_READ)
        self.participants: list[Participant] = []
        self._come = 0  # participants of the submission
        self._box = BoxProcesses(self._process.pid, self._process.walled, self._apart)
        self.clock = FairClock(self._everybody)
        # The thread that waits for them looks at them again and again, and each time it waits for a processor.
        self.clock_but_mine = FairClock(self._everybody, threading.get_native_id())
        self._tree = ProcessTree(self._box.age, self.clock.now, self.clock.delayed)
        self.now_ns = 0  # simulated time, told to processes that ask for it
        self.exit_code: int | None = None
        self.hid = False  # whether it closed its end of the socket and lived on

    @property
    def running(self) -> bool:
        """Whether the end of the first process has not been seen yet."""
        return self.exit_code is None

    @property
    def limit(self) -> str | None:
        """The limit for which it was ended (memory, processes or disk), or None."""
        return self._process.broken_limit

    @property
    def stopped(self) -> bool:
        """Whether one of its processes was stopped (SIGSTOP) and not continued."""
        return any(is_stopped(each) for each in self._members())

    def wait(self, timeout: float) -> bool:
        """Wait at most `timeout` [s] for output, progress or the end; return whether something came."""
        if not self.running:
            return False
        ready = self._selector.select(timeout)
        self.log.read()
        self._read_participants()
        if any(each.number == 0 and each.gone for each in self.participants) or self._process.poll() is not None:
            self._reap()
        return bool(ready)

    @property
    def followed(self) -> list[Participant]:
        """The processes with nodes that spin, sorted by name, so that equal runs have the same order."""
        return sorted((p for p in self.participants if p.progress and not p.gone), key=lambda p: p.name)

    @property
    def spun(self) -> bool:
        """Whether a node of it was ever spun, or published something."""
        return any(p.progress.spun or p.progress.published for p in self.participants if p.progress)

    @property
    def layout(self) -> tuple[int, ...]:
        """A value that changes when a process or an endpoint comes or goes."""
        return tuple(-1 if p.gone else id(p.progress.endpoints) if p.progress else 0 for p in self.participants)

    @property
    def starting(self) -> bool:
        """Whether a process is about to become one that is followed. After `MOST_IN_VAIN` that never did, none is."""
        return self._come == 0 or self._starts()

    def _starts(self, without: Participant | None = None) -> bool:
        """Whether a process is about to be followed, other than one."""
        others = sum(_has_come_in_vain(each) for each in self.participants)
        if others + self._tree.in_vain >= MOST_IN_VAIN:
            return False
        return self._tree.changing or any(p.starting for p in self.participants if p is not without)

    @property
    def endpoints(self) -> tuple[Endpoint, ...]:
        """The endpoints of the nodes of all processes, as last reported."""
        return tuple(e for p in self.followed if p.progress for e in p.progress.endpoints)

    def _read_participants(self) -> None:
        while (accepted := _accepted(self._listener)) is not None:
            if self._come >= MOST_PARTICIPANTS or not self._is_new(Peer.of(accepted)):
                accepted.close()
                continue
            self._join(Participant(accepted, self._come, self._hear))
            self._come += 1
        while self.beside is not None and (accepted := _accepted(self.beside.door)) is not None:
            if any(p.number == NUMBER for p in self.participants) or not self.beside.holds(Peer.of(accepted)):
                accepted.close()
            else:
                self._join(Participant(accepted, NUMBER, self._answer))
        for each in self.participants:
            if not each.gone:
                self._read(each)
        if self.beside is not None:  # only now: what it has reported before its threads came to rest is there
            self.beside.read()
            if self.beside.gone and self.beside.link in self._selector.get_map():
                self._selector.unregister(self.beside.link)

    def _join(self, participant: Participant) -> None:
        self.participants.append(participant)
        self._selector.register(participant.channel, selectors.EVENT_READ)

    def _is_new(self, peer: Peer) -> bool:
        """Whether a process of the box has connected, and has no connection yet."""
        for each in self.participants:
            if each.peer.pid == peer.pid and not each.gone:  # it may have closed the one it had, to execute a program
                self._read(each)
                if not each.gone and each.peer == peer:
                    return False
        return self._box.holds(peer) or (not peer.alive and self._tree.knows(peer.pid))

    def _read(self, each: Participant) -> None:
        each.read()
        if each.gone:
            self._selector.unregister(each.channel)
            if each.number != NUMBER:
                self._tree.leave(each.pid)

    def _hear(self, who: Participant, message: dict[str, Any]) -> None:
        self._tree.hear(message)
        self._answer(who, message)
        self.asked(who, message)

    def _answer(self, who: Participant, message: dict[str, Any]) -> None:
        """Answer what any process may ask."""
        if "clock" in message:
            who.tell({"now": self.now_ns})
        if "time" in message:
            who.tell({"answer": {"now": self.clock.now(), "delayed": self.clock_but_mine.delayed()}})
        if "looking" in message:
            others_work = any(p.works and not p.looking for p in self.participants if p is not who)
            who.tell({"answer": {"others": others_work or self._starts(who), "now": self.clock.now()}})

    def _reap(self) -> None:
        """Take the exit code of a process that has exited; end one that only closed its end of the socket."""
        if not self._ends_within(GRACE):
            self.hid = True
            self.stop()
        self.log.read()
        self._read_participants()
        self.log.finish()
        self.exit_code = self._process.returncode

    def signal(self, number: signal.Signals) -> None:
        """Send a signal as a terminal would: to the first process and all in its process group."""
        self._process.signal(number)

    def ended_programs(self) -> list[dict[str, Any]]:
        """Return `program` and exit `code` of the ended programs that had said hello, as reported by their parents."""
        codes = self._tree.codes()
        return [{"program": p.program, "code": codes[p.pid]} for p in self.participants if p.pid in codes]

    def started_by_submission(self, who: Participant) -> bool:
        """Whether the submission's own code has started a process, by what it reports."""
        return not self._tree.is_ours(who.pid)

    def stop(self) -> None:
        """End the process group and every descendant: SIGINT, then SIGTERM, then SIGKILL."""
        for each in self.participants:
            with contextlib.suppress(OSError):
                each.channel.shutdown(socket.SHUT_WR)  # nobody will answer it any more
        if self._process.poll() is None:
            for escalation in (signal.SIGINT, signal.SIGTERM):
                self._process.signal(escalation)
                if self._ends_within(GRACE):
                    break
        self._process.kill()
        self.exit_code = self._process.wait()
        if self.beside is not None:
            self.beside.stop()
        self._sweep()

    def _ends_within(self, seconds: float) -> bool:
        """Wait for the end of the first process; return whether it came in time."""
        patience = Patience(self.clock, seconds)
        while not patience.over():
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(LOOK_AGAIN)
                return True
        return False

    def cpu_seconds(self) -> float:
        """Return the processor time [s] of all running processes, and of the ended ones they have waited for."""
        return sum(cpu_seconds(each, with_ended=True) for each in self._members())

    def _everybody(self) -> list[int]:
        return [os.getpid(), *self._members(), *(self.beside.members() if self.beside is not None else ())]

    def _members(self) -> list[int]:
        return descendants(os.getpid(), self._apart)

    def _sweep(self) -> None:
        """Kill what has left the process group: as subreaper the grader inherits every orphan."""
        while strays := _children() - self._children_before:
            for stray in strays:
                with contextlib.suppress(psutil.NoSuchProcess):
                    stray.kill()
            psutil.wait_procs(strays, timeout=GRACE)

    def close(self) -> None:
        """End the process if it still runs and close every descriptor."""
        self.stop()
        self._selector.close()
        self._listener.close()
        for each in self.participants:
            each.close()
        self.log.close()


def _accepted(door: socket.socket) -> socket.socket | None:
    """Return the next connection that was made, or None."""
    try:
        return door.accept()[0]
    except OSError:
        return None


def _has_come_in_vain(participant: Participant) -> bool:
    """Return whether a process with rclpy has ended, or was waited for long enough, and never had a node that spins."""
    return participant.uses_ros and not participant.joined and (participant.gone or not participant.follows)


def _unasked(asking: Participant, message: dict[str, Any]) -> None: ...


def _children() -> set[psutil.Process]:
    return set(psutil.Process().children(recursive=True))
