"""Simulated time at the pace of the wall clock, and what every pace needs: the processes and what has arrived.

Every patience is counted by the clock of the processes, which stands still while they wait for a processor. Used by
`run_loop.py` for runs in real time; `lockstep.py` builds on it.
"""

from __future__ import annotations

import time
from collections import Counter
from typing import TYPE_CHECKING, Any

from gz_course.grader.run.fair_clock import Patience
from gz_course.grader.run.limits import MOST_HELD
from gz_course.grader.run.pace.log_arrival import LogArrival
from gz_course.grader.run.pace.matching import can_match
from gz_course.grader.run.processes.participant import Participant
from gz_course.grader.run.processes.process_tree import START_UP
from gz_course.grader.run.processes.progress import Endpoint
from gz_course.grader.run.processes.submission_processes import SubmissionProcesses

if TYPE_CHECKING:
    from gz_course.grader.run.grader_endpoints import GraderEndpoints

PATIENCE = 3.0  # [s] a node may need for one message before it is paced
MATCHING = 5.0  # [s] for DDS to match the endpoints of a new node; a lost announcement costs 3 s
# A tick of wall time is prolonged by what others took from the nodes since the last one, to so many ticks at most: on a
# machine that is busier than that, the delays of one tick would prolong the next, and so on without end.
LONGEST_TICK = 20
LOOK_ROUND = 0.002  # [s] to wait for the student's processes between two looks at ROS


class RealTime:
    """Paces simulated time to the wall clock and never waits for a node."""

    name = "realtime"

    def __init__(self, processes: SubmissionProcesses, ros: GraderEndpoints) -> None:
        self.processes = processes
        self.ros = ros
        self.ros.look = self._look_who_was_found
        self.paced_ticks = 0
        self.held_up = 0.0  # [s] for which the processes were waited for that had not come to rest
        self.flooded = False  # whether more was sent at one simulated time than is allowed
        self._in_vain: set[tuple[str, ...]] = set()  # endpoints that did not match within `MATCHING`
        self._due: float | None = None
        self._delayed = 0.0  # [s] by which the clock of the processes had stood still when the last tick was paced
        self._starting: dict[Participant, Patience] = {}
        self._held = 0.0  # [s] for processes that start up
        self._lost: Counter[str] = Counter()  # published by the student, never arrived
        self._logs = LogArrival(processes, ros)

    def await_ready(self) -> bool:
        """Wait until every node waits, and DDS has matched its endpoints; False if none has come within `START_UP`.

        Who ends at once has ended when simulated time begins, whether DDS had time to match its endpoints or not.
        """
        clock, began = self.processes.clock, self.processes.clock.now()
        patience, whole = Patience(clock, START_UP), Patience(clock, MOST_HELD - self._held)
        while self.processes.running and (not self.processes.participants or self.processes.starting):
            for each in self.processes.participants:
                if each.starting:
                    each.tell({"ping": True})  # reveals that a process has closed its socket
                    its_own = self._starting.setdefault(each, Patience(clock, START_UP))
                    each.follows = not its_own.over()
            if not self.processes.participants and patience.over():
                return False
            if whole.over():
                break
            self.processes.wait(LOOK_ROUND * 10)
            self.ros.pump()
            self.everything_arrived()
        self._held += clock.now() - began
        self.await_matches()
        patience = Patience(clock, PATIENCE)
        while self.processes.running and not patience.over():
            arrived = self.everything_arrived()  # all that was sent before simulated time begins
            at_work = [each for each in self.processes.participants if each.works]
            if arrived and not at_work:
                break
            for each in at_work:
                each.tell({"ping": True})
            self.processes.wait(LOOK_ROUND * 10 if arrived else LOOK_ROUND)
        return self.processes.running and any(each.joined and not each.gone for each in self.processes.participants)

    @property
    def somebody_starts(self) -> bool:
        """Whether a process starts up for which simulated time is still held."""
        return self.processes.starting and self._held < MOST_HELD

    def welcome(self) -> None:
        """Let a process that has joined take part; in real time it is not waited for."""

    def await_matches(self) -> None:
        """Wait until every endpoint that can match has matched on both sides, for `MATCHING` at most.

        Who has not matched then is not waited for again.
        """
        patience = Patience(self.processes.clock, MATCHING)
        while self.processes.running and not self._matched() and not patience.over():
            for each in self.processes.participants:
                each.tell({"look": True})  # a process that sleeps does not look by itself
            self.processes.wait(LOOK_ROUND)
            self.ros.pump()
        missing = {each.identity for each in self._missing()}
        self._in_vain = missing if patience.over() else self._in_vain & missing

    def _matched(self) -> bool:
        """Return whether all have matched but those that were waited for in vain, such as for their deadline."""
        return all(each.identity in self._in_vain for each in self._missing())

    def _missing(self) -> list[Endpoint]:
        """Return the endpoints of the submission that should match the grader's, and have not on both sides."""
        endpoints = [e for e in self.processes.endpoints if can_match(e, self.ros)]
        wanted = Counter((e.topic, e.kind) for e in endpoints)
        short = {key for key, number in wanted.items() if self.ros.matched(*key) < number}
        return [e for e in endpoints if not e.matched or (e.topic, e.kind) in short]

    def everything_arrived(self) -> bool:
        """Return whether all that the processes published has arrived; then confirm it to those that wait for that."""

        def arrived() -> bool:
            received = self.ros.received
            return self._logs.complete() and all(
                received[topic] + self._lost[topic] >= count
                for topic, count in self._total("published").items()
                if self.ros.listens(topic)
            )

        if not arrived():
            self.ros.pump()
            if not arrived():
                return False
        for each in self.processes.participants:
            if each.wants_answer and not each.waiting_for_release:
                if each.progress and each.progress.held:
                    each.release(self.processes.clock.now())
                else:
                    each.answer()
        return True

    def _look_who_was_found(self) -> None:
        """Tell our endpoints when the publishers were found that had published something before."""
        self.processes.wait(0)
        for each in self.processes.participants:
            if each.progress is not None and each.progress.found_at:
                self.ros.found_at.update(each.progress.found_at)

    def too_early(self) -> dict[str, int]:
        """Return by topic how many messages the processes published before anybody had found the publisher."""
        return {topic: count for topic, count in sorted(self._total("lost").items()) if self.ros.listens(topic)}

    def _total(self, what: str) -> Counter[str]:
        """Sum one of the counters over all processes, including those that have ended."""
        total: Counter[str] = Counter()
        for each in self.processes.participants:
            if each.progress is not None:
                total.update(getattr(each.progress, what))
        return total

    def send(self, topic: str, publisher: Any, message: Any, now_ns: int) -> None:
        """Publish one message of the simulator at simulated time `now_ns` [ns]."""
        publisher.publish(message)

    def ask(self, client: Any, request: Any) -> Any:
        """Send a request to a service of the submission; return the answer, or None if there is none.

        The service may need `MATCHING` to be found, and the answer `PATIENCE` to arrive.
        """
        found = Patience(self.processes.clock, MATCHING)
        while not client.service_is_ready():
            if not self._look_for_answer(found):
                return None
        self._expect(client.service_name)
        answer = client.call_async(request)
        self.settle()
        arrived = Patience(self.processes.clock, PATIENCE)
        while not answer.done():
            if not (self._has_answered(client.service_name) and self._look_for_answer(arrived)):
                return None
        return answer.result()

    def _look_for_answer(self, patience: Patience) -> bool:
        """Take what has arrived from a service; return False if there is nothing to wait for any more."""
        if not self.processes.running or patience.over():
            return False
        self.processes.wait(LOOK_ROUND)
        self.ros.pump()
        self.everything_arrived()
        return True

    def _expect(self, service: str) -> None:
        """Note that a request to a service is about to be sent."""

    def _has_answered(self, service: str) -> bool:
        """Return False if it is known that the request was not answered; in real time the answer may be under way."""
        return True

    def wake_sleepers(self, now_ns: int) -> None:
        """Wake those who sleep in simulated time until `now_ns` [ns]; in real time they sleep in real time."""

    def settle(self) -> None:
        """Wait for the consequences of the last message; in real time there is no waiting."""

    def close_tick(self, tick: float) -> None:
        """Receive messages until the wall clock has advanced by `tick` [s], and by what others took from the nodes.

        In all it takes `LONGEST_TICK` ticks at most.
        """
        now, delayed = time.monotonic(), self.processes.clock.delayed()
        self._due = max(now - tick, self._due) + tick if self._due is not None else now + tick
        self._due = min(self._due + delayed - self._delayed, now + LONGEST_TICK * tick)
        self._delayed = delayed
        while True:
            left = self._due - time.monotonic()
            if left <= 0:
                break
            if self.processes.running:
                self.processes.wait(min(left, LOOK_ROUND))
            else:
                time.sleep(left)  # the submission has ended; only the clock goes on
            self.ros.pump()
            self.everything_arrived()
        self.ros.pump()
