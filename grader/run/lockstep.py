"""Keeps simulated time and a student's node in step: a tick ends when nothing is left to do.

The simulator publishes one message at a time and waits until the student's process has taken it and is idle, and
until everything that process published has arrived here. Nothing depends on the speed of the machine. A node that
cannot be followed (it blocks, or never spins) is paced to the wall clock for as long as that lasts: it is never
waited for in vain for more than `PATIENCE` at a time. `RealTime` is the same interface without the waiting.
"""

from __future__ import annotations

import time
from collections import Counter
from typing import Any, Protocol

from grader.run.participant import qos_can_match
from grader.run.student import Endpoint, Student

PATIENCE = 3.0  # [s] of wall time a node may need for one message before it is paced
GIVING_UP = 3  # after so many times it is paced for the rest of the run
START_UP = 10.0  # [s] of wall time from process start to a node that spins
MATCHING = 5.0  # [s] of wall time for DDS to match the endpoints of a new node; a lost announcement costs 3 s
CLOCK_AGAIN = 0.05  # [s] /clock is best effort on the student's side, so it is sent again until it was seen
LOOK_ROUND = 0.002  # [s] how long to listen to the student before listening to ROS
CLOCK = "/clock"


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

    def matched(self, topic: str, kind: str) -> int:
        """How many remote endpoints of a kind (publisher or subscription) are matched on a topic."""


def can_match(endpoint: Endpoint, ears: Ears) -> bool:
    """Whether DDS will ever connect this endpoint with the grader's."""
    ours = ears.listens if endpoint.kind == "publisher" else ears.publishes
    if endpoint.kind == "subscription" and endpoint.reliability == "RELIABLE" and not ears.reliable(endpoint.topic):
        return False
    return ours(endpoint.topic) == endpoint.type and qos_can_match(
        endpoint.kind, endpoint.reliability, endpoint.durability
    )


class RealTime:
    """Paces simulated time to the wall clock and waits for nobody."""

    name = "realtime"

    def __init__(self, student: Student, ears: Ears) -> None:
        self.student = student
        self.ears = ears
        self.paced_ticks = 0
        self._due: float | None = None
        self._lost: Counter[str] = Counter()  # published by the student, never arrived

    def await_ready(self) -> bool:
        """Wait until the node spins and DDS has matched its endpoints; False if it does not within `START_UP`."""
        deadline = time.monotonic() + START_UP
        while self.student.running and not (self.student.progress and self.student.progress.endpoints):
            if time.monotonic() > deadline:
                return False
            self.student.wait(LOOK_ROUND * 10)
            self.ears.pump()
            self.everything_arrived()
        self.await_matches(time.monotonic() + MATCHING)
        return self.student.running

    def await_matches(self, deadline: float) -> None:
        """Wait until every endpoint that can match has matched on both sides."""
        while self.student.running and time.monotonic() < deadline:
            endpoints = self.student.progress.endpoints if self.student.progress else ()
            wanted = Counter((e.topic, e.kind) for e in endpoints if can_match(e, self.ears))
            if all(self.ears.matched(topic, kind) >= n for (topic, kind), n in wanted.items()) and all(
                e.matched for e in endpoints if can_match(e, self.ears)
            ):
                return
            self.student.wait(LOOK_ROUND)
            self.ears.pump()

    def everything_arrived(self) -> bool:
        """Whether all that the student's process says it published is here; answers it if it waits for that."""
        published = self.student.progress.published if self.student.progress else {}

        def arrived() -> bool:
            received = self.ears.received
            return all(
                received[topic] + self._lost[topic] >= count
                for topic, count in published.items()
                if self.ears.listens(topic)
            )

        if not arrived():
            self.ears.pump()
            if not arrived():
                return False
        if self.student.wants_answer:
            self.student.answer()
        return True

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


class LockStep(RealTime):
    """Waits after every message until the student's node has dealt with it."""

    name = "lockstep"

    def __init__(self, student: Student, ears: Ears) -> None:
        super().__init__(student, ears)
        self._sent: Counter[str] = Counter()  # messages the student's process must have taken
        self._seen_endpoints: tuple[Endpoint, ...] | None = None
        self._pending: tuple[str, Any, Any] | None = None
        self._now_ns = 0
        self._free = False  # paced at the moment
        self._failures = 0

    def await_ready(self) -> bool:
        """As in real time; a node that does not become ready is paced from the start."""
        ready = super().await_ready()
        self._free = not ready
        return ready

    def send(self, topic: str, publisher: Any, message: Any, now_ns: int) -> None:
        """Publish one message; what nobody subscribes to is not published at all."""
        self._now_ns = now_ns
        self._pending = None
        if not self.student.running:
            return
        progress = self.student.progress
        if progress is not None and progress.endpoints is not self._seen_endpoints:
            self._seen_endpoints = progress.endpoints
            self.await_matches(time.monotonic() + MATCHING)
        readers = self.ears.matched(topic, "subscription")
        if not readers:
            # Nobody to wait for, but somebody to listen to: a node may come, go, or wait for an answer.
            self.student.wait(0)
            self.everything_arrived()
            return
        publisher.publish(message)
        if topic != CLOCK:
            self._sent[topic] += readers
        self._pending = (topic, publisher, message)

    def settle(self) -> None:
        """Wait until the message just sent was taken and its consequences have arrived."""
        if self._pending is None or self._free:
            return
        topic, publisher, message = self._pending
        deadline = time.monotonic() + PATIENCE
        resend = time.monotonic() + CLOCK_AGAIN
        while not self._settled():
            if not self.student.running:
                self._take_last_words()
                return
            if not self.student.wait(LOOK_ROUND):
                self.ears.pump()
            now = time.monotonic()
            if now > deadline:
                self._fall_out_of_step()
                return
            if topic == CLOCK and now > resend:
                publisher.publish(message)
                resend = now + CLOCK_AGAIN

    def close_tick(self, tick: float) -> None:
        """Nothing to wait for in step; a node that fell out of step gets its tick of wall time."""
        if not self._free or not self.student.running:
            return
        self.paced_ticks += 1
        super().close_tick(tick)
        if self._failures < GIVING_UP and self._settled():
            self._free = False
            self._due = None

    def _settled(self) -> bool:
        progress = self.student.progress
        if progress is None or not self.everything_arrived():
            return False
        if progress.clock is not None and progress.clock < self._now_ns:
            return False
        return all(progress.taken.get(topic, 0) >= count for topic, count in self._sent.items())

    def _take_last_words(self) -> None:
        """The process has ended: wait for what it published just before."""
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline and not self.everything_arrived():
            pass

    def _fall_out_of_step(self) -> None:
        """Stop waiting: what was not taken by now counts as lost, and time goes on at the pace of the wall."""
        self._free = True
        self._failures += 1
        progress = self.student.progress
        if progress is None:
            return
        for topic in self._sent:
            self._sent[topic] = progress.taken.get(topic, 0)
        for topic, count in progress.published.items():
            self._lost[topic] = max(0, count - self.ears.received[topic])
