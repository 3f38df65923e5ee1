"""Lock-step of simulated time and the student's nodes: a tick ends when nothing is left to do.

The simulator publishes one message at a time and waits until the student's processes have taken it and are idle, and
until everything they published has arrived. Messages between several processes, or from several processes to the
simulator at the same time, would be a race: the processes hold them back and release one at a time on order, always in
the same sequence. Who sleeps does so in simulated time, and is woken when it has come. Nothing depends on the speed of
the machine. While a node cannot be followed (it blocks, or never spins), simulated time is paced to the wall clock;
waiting for one message takes `PATIENCE` at most, and at one simulated time at most `MOST_AT_ONCE` messages are sent.
`real_time.py` has the same interface without the waiting.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Collection
from typing import TYPE_CHECKING, Any

from gz_course.grader.run.agent.course_agent.executor_monitor import HOUSEKEEPING
from gz_course.grader.run.agent.course_agent.rosout_counter import ROSOUT
from gz_course.grader.run.fair_clock import Patience
from gz_course.grader.run.pace.late_joiners import LateJoiners
from gz_course.grader.run.pace.matching import can_match, will_match
from gz_course.grader.run.pace.real_time import LOOK_ROUND, PATIENCE, RealTime
from gz_course.grader.run.processes.participant import Participant
from gz_course.grader.run.processes.progress import Endpoint
from gz_course.grader.run.processes.submission_processes import SubmissionProcesses

if TYPE_CHECKING:
    from gz_course.grader.run.grader_endpoints import GraderEndpoints

MOST_AT_ONCE = 10_000  # messages that may be sent while simulated time stands still
GIVING_UP = 3  # failures after which the rest of the run is paced
CLOCK_AGAIN = 0.05  # [s] /clock is best effort on the student's side, so it is sent again until it is seen
LOST = 0.1  # [s] if everybody is idle and a message was not taken for this time, it is sent again
LOST_PATIENCE = 10.0  # [s] for a message that is lost repeatedly, unless waiting has failed before
STRAYS = 0.05  # [s] between two looks at threads that wait in a call that is not watched
MOST_WAKES = 1_000  # of one process in a tick; a thread sleeps for a millisecond at least
CLOCK = "/clock"


class LockStep(RealTime):
    """Waits after every message until the student's nodes have dealt with it.

    `holding`: the processes were started with holding on. Otherwise they are ordered to hold once there are several.
    """

    name = "lockstep"

    def __init__(self, processes: SubmissionProcesses, ros: GraderEndpoints, holding: bool = False) -> None:
        super().__init__(processes, ros)
        self._holding = holding
        self._sent: Counter[str] = Counter()  # messages that the student's processes must have taken
        self._untaken: Counter[str] = Counter()  # of those and of their own: never taken (or taken and never counted)
        self._answers: Counter[str] = Counter()  # responses that the grader takes
        self._late = LateJoiners()
        self._kept: Counter[str] = Counter()  # messages sent on topics that keep some for subscriptions that join late
        self._layout: tuple[int, ...] = ()
        self._participants: list[Participant] = []
        self._pending: tuple[str, Any, Any] | None = None
        self._clock: tuple[Any, Any] | None = None  # publisher and message of the last /clock
        self._now_ns = -1
        self._sent_before = 0  # what the processes had sent when simulated time reached this value
        self._released = 0  # messages since then that were held
        self._free = False  # paced at the moment
        self._failures = 0
        self._copies = 0  # copies of the message just sent, which was lost
        self._left: tuple[int, ...] = ()  # the layout in which a subscription is gone and its process is not
        self._gone: set[int] = set()  # numbers of the processes with nodes that were seen to have gone

    def await_ready(self) -> bool:
        """Wait as in real time; a node that does not become ready is paced to the wall clock from the start."""
        ready = super().await_ready()
        if self._look_around():
            self.await_matches()
        self._free = not ready
        return ready

    def welcome(self) -> None:
        """Hold simulated time while a process that has joined starts up."""
        if self.processes.running and self.somebody_starts and not self._free:
            RealTime.await_ready(self)
        if not self._free and self._look_around():
            self.await_matches()

    def _look_around(self) -> bool:
        """Return whether processes or endpoints have come or gone since the last call, and update what is followed."""
        if self.processes.layout == self._layout:
            return False
        self._layout = self.processes.layout
        self._participants = self.processes.followed
        keeping = [(f"{t} {kind}", t, self.ros.keeps(t)) for t, kind in self.ros.offered.items()]
        kept = {key: min(self._kept[topic], most) for key, topic, most in keeping if most}
        self._late.look(self._participants, kept)
        self._holding |= len(self._participants) > 1
        for each in self._participants if self._holding and not self._free else []:
            if each.progress and not each.progress.holding:
                each.tell({"hold": True})
        if gone := {p.number for p in self.processes.participants if p.gone and p.progress}:
            self._write_off(self._awaited(gone - self._gone))
            self._gone = gone
        return True

    def _awaited(self, just_gone: set[int]) -> set[str]:
        """Return the topics on which messages may still be on their way to somebody who is there.

        If one of their subscribers has just gone, it is not known to whom the messages were sent.
        """
        everybody = self.processes.participants
        lost = {topic for p in everybody if p.number in just_gone for topic in p.heard}
        return {topic for p in everybody if not p.gone for topic in p.heard} - lost

    def _tell(self, order: dict[str, Any]) -> None:
        for each in self.processes.participants:
            if not each.gone:
                each.tell(order)

    def _matched(self) -> bool:
        free = self._free or not self._holding
        holding = free or all(each.progress and each.progress.holding for each in self._participants)
        return holding and super()._matched()

    def _missing(self) -> list[Endpoint]:
        return super()._missing() + (self._missing_each_other() if self._holding else [])

    def _missing_each_other(self) -> list[Endpoint]:
        endpoints = [e for e in self.processes.endpoints if e.topic not in HOUSEKEEPING]
        publishers = [e for e in endpoints if e.kind == "publisher"]
        subscriptions = [e for e in endpoints if e.kind == "subscription"]
        missing = []
        for e in publishers:
            others = sum(will_match(e, other) for other in subscriptions)
            missing += [e] if e.matched < can_match(e, self.ros) + others else []
        for e in subscriptions:
            others = sum(will_match(other, e) for other in publishers)
            missing += [e] if e.matched < can_match(e, self.ros) + others else []
        return missing

    def send(self, topic: str, publisher: Any, message: Any, now_ns: int) -> None:
        """Publish one message, unless nobody subscribes to it."""
        if now_ns != self._now_ns:
            self._now_ns, self._sent_before = now_ns, self._total("published").total()
            self._released = 0
        self._pending = None
        if topic == CLOCK:
            self._clock = publisher, message
        if not self.processes.running:
            return
        if self._look_around():
            self.await_matches()
        readers = self.ros.matched(topic, "subscription") or self._await_leaving(topic)
        kept = self.ros.keeps(topic) > 0
        self._kept[topic] += kept
        if not readers:
            # No reader to wait for, but a node may come, go, or wait for an answer.
            if kept:
                publisher.publish(message)
            self.processes.wait(0)
            self.everything_arrived()
            return
        publisher.publish(message)
        if topic != CLOCK:
            self._sent[topic] += readers
        self._pending = (topic, publisher, message)

    def _await_leaving(self, topic: str) -> int:
        """Hold simulated time while a process ends whose subscription DDS has removed already.

        Return how many subscriptions are matched on the topic. A process that lives on without its subscription is
        waited for once only.
        """
        layout, patience = self.processes.layout, Patience(self.processes.clock, PATIENCE)
        mine = (e for e in self.processes.endpoints if e.kind == "subscription" and e.topic == topic)
        if self._free or layout == self._left or not any(can_match(e, self.ros) for e in mine):
            return 0
        while self.processes.running and self.processes.layout == layout:
            if readers := self.ros.matched(topic, "subscription"):
                return readers
            if patience.over():
                self._left = layout
                break
            self.processes.wait(LOOK_ROUND)
            self.everything_arrived()
        return 0

    def _expect(self, service: str) -> None:
        """Count a request, which the submission must take, and its response, which the grader takes."""
        self._sent[f"request {service}"] += 1
        self._answers[f"response {service}"] += 1
        self._pending = (f"request {service}", None, None)

    def _has_answered(self, service: str) -> bool:
        """Return whether the response has left, after all has come to rest; a node that sleeps answers later."""
        response = f"response {service}"
        return self._free or self._total("delivered")[response] >= self._answers[response]

    def wake_sleepers(self, now_ns: int) -> None:
        """Wake those who sleep until `now_ns` [ns] one at a time, and wait for the consequences of each.

        First comes who is due first, then by the names of nodes. They come before the messages of this tick.
        """
        self._pending = None
        woken: Counter[int] = Counter()
        while self.processes.running and not self._free:
            due = [p for p in self._participants if _sleeps_until(p, now_ns) and woken[p.number] < MOST_WAKES]
            if not due:
                break
            first = min(due, key=lambda p: (p.progress.wakes if p.progress else 0, p.name))
            woken[first.number] += 1
            first.wake(first.progress.wakes if first.progress and first.progress.wakes else now_ns)
            self._settle()
        self.processes.now_ns = now_ns
        for each in self.processes.participants:
            if self._free and _sleeps_until(each, now_ns):
                each.wake(now_ns, every=True)
            elif not each.gone and each.progress is not None and each.progress.clock is None:
                each.tell({"now": now_ns})  # no node of it gets /clock

    def settle(self) -> None:
        """Wait until the message just sent was taken and its consequences have arrived.

        Then release the messages the processes hold, one at a time, and wait in the same way for each. Who is at work
        although there was no message for it (its node is gone, and it ends) is waited for, too.
        """
        holding = self._holding and self._participants
        if not self._free and (self._pending or holding or any(each.works for each in self._participants)):
            self._settle()

    def _settle(self) -> None:
        if not self._await_settled():
            return
        self._pending = None
        while self._holding and (holder := next((p for p in self._participants if _holds(p)), None)) is not None:
            holder.release(self.processes.clock.now())
            self._released += 1
            if self._is_flooded() or not self._await_settled():
                return

    def _await_settled(self) -> bool:
        """Wait until no message is in transit and every process is idle; return False on a timeout.

        How long that took is judged only while it goes on: who had come to rest before this thread got a processor to
        see it has held nobody up.
        """
        self._copies = 0
        resend = time.monotonic() + CLOCK_AGAIN
        lost = time.monotonic() + LOST
        strays = time.monotonic() + STRAYS
        self._have_taken()
        clock, held_up = self.processes.clock_but_mine, self.held_up
        patience = Patience(clock, PATIENCE)
        give_up = Patience(clock, PATIENCE if self._failures else LOST_PATIENCE)
        while not self._settled():
            self.held_up = held_up + patience.waited()
            if patience.over():
                self._fall_out_of_step()
                return False
            if not self.processes.running:
                self._take_last_words()
                return False
            if not self.processes.wait(LOOK_ROUND):
                self.ros.pump()
                self._have_taken()
            now = time.monotonic()
            if now > strays:
                for each in self._participants:
                    if each.progress and not each.progress.idle:
                        each.tell({"strays": True})
                strays = now + STRAYS
            if self._is_flooded():
                return False
            if self._clock and now > resend and any(self._is_behind(each) for each in self._participants):
                publisher, message = self._clock  # also for a node that has come since it was sent
                publisher.publish(message)
                resend = now + CLOCK_AGAIN
            if now > lost and self._is_lost():
                self._send_again()
                lost = now + LOST
                if self._copies and not give_up.over():
                    patience, held_up = Patience(clock, PATIENCE), self.held_up
        return True

    def _is_flooded(self) -> bool:
        """Return whether more was sent at this simulated time than is allowed; then the run is over."""
        sent = self._total("published").total() - self._sent_before
        self.flooded |= max(sent, self._released) > MOST_AT_ONCE
        return self.flooded

    def _have_taken(self) -> None:
        """Let the messages be taken for which a node has no time at the moment."""
        for each in self._participants:
            if each.progress and each.progress.blocked and not each.gone:
                each.tell({"take": True})

    def _is_lost(self) -> bool:
        """Return whether every process is idle although one has not taken the message just sent."""
        if self._pending is None or self._pending[0] == CLOCK:
            return False
        topic = self._pending[0]
        missing = self._due_to_be_taken()[topic] - self._total("taken")[topic] - self._untaken[topic]
        return missing > 0 and all(p.progress and p.progress.idle for p in self._participants)

    def _send_again(self) -> None:
        """Send the message again once all processes know that they may get it twice; until then announce that."""
        assert self._pending is not None
        topic, publisher, message = self._pending
        if not self.ros.is_large(message):
            return  # a small message is not lost; its reader does not take it
        unaware = [p for p in self._participants if p.progress and topic not in p.progress.again]
        for each in unaware:
            each.tell({"again": topic})
        if not unaware:
            publisher.publish(message)
            self._copies += 1

    def close_tick(self, tick: float) -> None:
        """Let the wall clock advance by a tick if the nodes are out of step; check if they are in step again."""
        if not self._free or not self.processes.running:
            return
        self.paced_ticks += 1
        super().close_tick(tick)
        if self._failures < GIVING_UP and self._settled():
            self._free = False
            self._due = None
            if self._holding:
                self._tell({"hold": True})

    def _settled(self) -> bool:
        """Return whether a tick may end: all arrived, all idle, the clock seen by all, every message taken."""
        if self._look_around():
            self.await_matches()
        if not any(each.progress for each in self.processes.participants) or not self.everything_arrived():
            return False  # somebody may be there whom nobody can follow
        for each in self._participants:
            progress = each.progress
            if progress is None or not progress.idle or each.waiting_for_release or self._is_behind(each):
                return False
        taken = self._total("taken")
        due = self._due_to_be_taken()
        if any(taken[topic] + self._untaken[topic] < count for topic, count in due.items()):
            return False
        if self._holding:  # a late subscription may have got more than was sent to it
            self._untaken.update({topic: count - taken[topic] - self._untaken[topic] for topic, count in due.items()})
        return True

    def _is_behind(self, participant: Participant) -> bool:
        """Return whether a node of it has not got the /clock of this simulated time."""
        clock = participant.progress.clock if participant.progress else None
        return clock is not None and clock < self._now_ns

    def _due_to_be_taken(self) -> Counter[str]:
        """Count by topic the messages that the processes must have taken: the simulator's and each other's."""
        due = self._sent + self._late.due
        if not self._holding:
            return due
        due += self._total("delivered")
        for topic, count in self._total("published").items():
            if self.ros.listens(topic) or topic == ROSOUT:
                due[topic] -= count  # one of the readers is the grader
        for name, count in self._answers.items():
            due[name] = max(0, due[name] - count)
        return due

    def _write_off(self, awaited: Collection[str] = ()) -> None:
        """Count as lost what was not taken by now, but for `awaited`: its reader is gone or does not respond."""
        taken = self._total("taken")
        for topic, count in self._due_to_be_taken().items():
            if topic not in awaited:
                self._untaken[topic] = max(self._untaken[topic], count - taken[topic])

    def _take_last_words(self) -> None:
        """Wait for what the processes published just before they ended."""
        patience = Patience(self.processes.clock, PATIENCE)
        while not self.everything_arrived() and not patience.over():
            pass

    def _fall_out_of_step(self) -> None:
        """Stop waiting: count as lost what was not taken by now, and continue at the pace of the wall clock."""
        self._free = True
        self._failures += 1
        self._tell({"free": True})
        self._write_off()
        for topic, count in self._total("published").items():
            self._lost[topic] = max(0, count - self.ros.received[topic])


def _sleeps_until(participant: Participant, now_ns: int) -> bool:
    """Return whether a thread of it sleeps that is due at `now_ns` [ns]."""
    if participant.gone or participant.progress is None or participant.progress.wakes is None:
        return False
    return participant.progress.wakes <= now_ns


def _holds(participant: Participant) -> bool:
    return not participant.gone and participant.progress is not None and participant.progress.held > 0
