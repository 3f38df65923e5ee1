"""Paces simulated time to the wall clock; and what any pace needs: who is there, and whether all they sent has arrived.

Used by `stage.py` and `launch_stage.py` when a run is asked for in real time; `lockstep.py` builds on it.
"""

from __future__ import annotations

import time
from collections import Counter
from typing import Any, Protocol

from gz_course.grader.run.children import START_UP
from gz_course.grader.run.matching import can_match
from gz_course.grader.run.student import Student

PATIENCE = 3.0  # [s] of wall time a node may need for one message before it is paced
MATCHING = 5.0  # [s] of wall time for DDS to match the endpoints of a new node; a lost announcement costs 3 s
LOOK_ROUND = 0.002  # [s] how long to listen to the student before listening to ROS


class Ears(Protocol):
    """The grader's own ROS side."""

    received: Counter[str]  # messages that arrived here, by topic

    def pump(self) -> None:
        """Take everything that has arrived."""

    def publishes(self, topic: str) -> str | None:
        """ROS type of what the grader publishes on a topic."""

    def listens(self, topic: str) -> str | None:
        """ROS type of what the grader subscribes to on a topic."""

    def reliable(self, topic: str) -> bool:
        """Whether the grader publishes reliably on a topic."""

    def is_large(self, message: Any) -> bool:
        """Whether a message crosses the network in several packets and says when it was made."""

    def matched(self, topic: str, kind: str) -> int:
        """How many remote endpoints of a kind (publisher or subscription) are matched on a topic."""


class RealTime:
    """Paces simulated time to the wall clock and waits for nobody."""

    name = "realtime"

    def __init__(self, student: Student, ears: Ears) -> None:
        self.student = student
        self.ears = ears
        self.paced_ticks = 0
        self.held_seconds = 0.0  # of wall time that went by in long waits for the student
        self._due: float | None = None
        self._lost: Counter[str] = Counter()  # published by the student, never arrived

    def await_ready(self) -> bool:
        """Wait until every node spins and DDS has matched its endpoints; False if none does within `START_UP`."""
        deadline = time.monotonic() + START_UP
        while self.student.running and (not self.student.participants or self.student.starting):
            now = time.monotonic()
            for each in self.student.participants:
                if each.starting:
                    each.tell({"ping": True})  # one that has closed its socket notices it only now
                    each.follows = now < each.since + START_UP
            if now > deadline and not self.student.participants:
                return False
            self.student.wait(LOOK_ROUND * 10)
            self.ears.pump()
            self.everything_arrived()
        self.await_matches(time.monotonic() + MATCHING)
        deadline = time.monotonic() + PATIENCE
        while self.student.running and not self.everything_arrived() and time.monotonic() < deadline:
            self.student.wait(LOOK_ROUND)  # what was sent before time began is also received before
        return self.student.running and bool(self.student.endpoints)

    def welcome(self) -> None:
        """Let a process that has come meanwhile take part; in real time nobody waits."""

    def await_matches(self, deadline: float) -> None:
        """Wait until every endpoint that can match has matched on both sides."""
        while self.student.running and time.monotonic() < deadline and not self._matched():
            self.student.wait(LOOK_ROUND)
            self.ears.pump()

    def _matched(self) -> bool:
        endpoints = self.student.endpoints
        wanted = Counter((e.topic, e.kind) for e in endpoints if can_match(e, self.ears))
        return all(self.ears.matched(topic, kind) >= n for (topic, kind), n in wanted.items()) and all(
            e.matched for e in endpoints if can_match(e, self.ears)
        )

    def everything_arrived(self) -> bool:
        """Whether all that the student's processes say they published is here; answers who waits for that."""

        def arrived() -> bool:
            received = self.ears.received
            return all(
                received[topic] + self._lost[topic] >= count
                for topic, count in self._total("published").items()
                if self.ears.listens(topic)
            )

        if not arrived():
            self.ears.pump()
            if not arrived():
                return False
        for each in self.student.participants:
            if each.wants_answer and not each.waiting_for_release:
                if each.progress and each.progress.held:
                    each.release()
                else:
                    each.answer()
        return True

    def _total(self, what: str) -> Counter[str]:
        """Sum of one of the counters of all processes, also those that have ended."""
        total: Counter[str] = Counter()
        for each in self.student.participants:
            if each.progress is not None:
                total.update(getattr(each.progress, what))
        return total

    def send(self, topic: str, publisher: Any, message: Any, now_ns: int) -> None:
        """Publish one message of the simulator at simulated time `now_ns` [ns]."""
        publisher.publish(message)

    def settle(self) -> None:
        """Wait for what the last message sent brings about; in real time nobody waits."""

    def close_tick(self, tick: float) -> None:
        """Listen until the wall clock has moved on by `tick` [s]."""
        now = time.monotonic()
        self._due = max(now - tick, self._due) + tick if self._due is not None else now + tick
        while True:
            left = self._due - time.monotonic()
            if left <= 0:
                break
            if self.student.running:
                self.student.wait(min(left, LOOK_ROUND))
            else:
                time.sleep(left)  # nobody to listen to; only the clock passes
            self.ears.pump()
            self.everything_arrived()
        self.ears.pump()
