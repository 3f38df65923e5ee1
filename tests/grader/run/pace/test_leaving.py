"""A process that ends: DDS takes its endpoints down first, and until it has gone simulated time stands still."""

import json
import socket
from collections import Counter
from types import SimpleNamespace
from typing import ClassVar

import pytest

from gz_course.grader.run.pace.lockstep import CLOCK, PATIENCE, LockStep
from gz_course.grader.run.processes.participant import Participant
from gz_course.grader.run.processes.progress import Endpoint

TYPE = "rosgraph_msgs/msg/Clock"


class Leaving:
    """The submission and the grader's ros: a subscription that DDS does not match any more, and a process that lives.

    Each wait takes a tenth of a second. After `waits` of them `then` happens.
    """

    participants = followed = ()
    endpoints = (Endpoint("/node", "subscription", CLOCK, TYPE, "BEST_EFFORT", "VOLATILE", 1),)
    layout = (1,)
    offered: ClassVar[dict[str, str]] = {}

    def __init__(self, waits, then):
        self.running = True
        self.readers = 0
        self.waits, self.then = waits, then
        self.waited = 0
        self.sent = []
        self.received: Counter[str] = Counter()

    def wait(self, timeout):
        self.waited += timeout > 0
        if self.waited == self.waits:
            self.then(self)

    def pump(self):
        pass

    def keeps(self, topic):
        return 0

    def listens(self, topic):
        return None

    def publishes(self, topic):
        return TYPE

    def reliable(self, topic):
        return False

    def matched(self, topic, kind):
        return self.readers

    def publish(self, message):
        self.sent.append(message)


def ends(leaving):
    leaving.running = False


def is_back(leaving):
    leaving.readers = 1


def lives_on(leaving):
    pass


@pytest.fixture
def tick(monkeypatch):
    """Send the clock of some ticks to whoever leaves."""

    def call(leaving, ticks=1):
        leaving.clock = SimpleNamespace(now=lambda: leaving.waited / 10)
        monkeypatch.setattr("gz_course.grader.run.fair_clock.SAMPLE", 0.0)
        pace = LockStep(leaving, leaving)
        pace._layout = leaving.layout
        for number in range(ticks):
            pace.send(CLOCK, leaving, f"tick {number}", number)
        return leaving

    return call


def test_time_stands_still_until_it_has_gone(tick):
    leaving = tick(Leaving(5, ends))
    assert (leaving.waited, leaving.running, leaving.sent) == (5, False, [])


def test_who_is_matched_again_gets_the_message(tick):
    leaving = tick(Leaving(5, is_back))
    assert (leaving.waited, leaving.sent) == (5, ["tick 0"])


def test_who_lives_on_without_it_is_waited_for_once(tick):
    leaving = tick(Leaving(5, lives_on), ticks=100)
    assert leaving.waited == pytest.approx(PATIENCE * 10, abs=2)
    assert leaving.sent == []


REPORT = {"clock": None, "idle": True, "taken": {}, "published": {}, "delivered": {}, "holding": False, "held": 0}
REPORT |= {"released": 0, "flushes": 0, "endpoints": []}
HELLO = {"node": "/hello", "kind": "publisher", "topic": "/hello", "type": "std_msgs/msg/String"}
HELLO |= {"reliability": "RELIABLE", "durability": "VOLATILE", "matched": 0}


class EndsAtOnce(Leaving):
    """A process that has a node for a moment: no look at DDS shows it. Then it is at work for some time and ends."""

    def __init__(self, waits):
        super().__init__(waits, ends)
        self.clock_but_mine = SimpleNamespace(now=lambda: self.waited / 10)
        ours, self.theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.participants = self.followed = [Participant(ours, 0, lambda *_: None)]
        self.report(endpoints=[HELLO], flushes=1)

    def report(self, **what):
        self.theirs.send(json.dumps(REPORT | what).encode())
        self.participants[0].read()

    @property
    def starting(self):
        return any(each.starting for each in self.participants)

    @property
    def endpoints(self):
        return self.participants[0].progress.endpoints

    @property
    def layout(self):
        return (id(self.endpoints),)

    def wait(self, timeout):
        super().wait(timeout)
        self.report(idle=False, flushes=1)

    def publishes(self, topic):
        return None

    def listens(self, topic):
        return HELLO["type"] if topic == "/hello" else None


@pytest.fixture
def brief(monkeypatch):
    """Such a process, and its pace."""
    leaving = EndsAtOnce(7)
    leaving.clock = leaving.clock_but_mine
    monkeypatch.setattr("gz_course.grader.run.fair_clock.SAMPLE", 0.0)
    yield leaving, LockStep(leaving, leaving)
    leaving.theirs.close()
    leaving.participants[0].close()


def test_simulated_time_begins_when_who_ends_at_once_has_ended(brief):
    leaving, pace = brief
    assert not pace.await_ready()
    assert (leaving.waited, leaving.running) == (7, False)


def test_who_is_at_work_without_a_node_is_waited_for(brief):
    leaving, pace = brief
    leaving.report(idle=False, flushes=1)
    pace.welcome()
    pace.send(CLOCK, leaving, "tick 1", 1)
    pace.settle()
    assert (leaving.waited, leaving.running, pace.paced_ticks) == (7, False, 0)


def test_nobody_is_waited_for_when_the_last_node_has_become_another_program(play):
    played = play(
        ticks=6,
        node="""
        import os
        from rosgraph_msgs.msg import Clock
        def leave(message):
            if message.clock.nanosec >= 300_000_000:
                os.execv("/bin/sleep", ["sleep", "600"])
        node.create_subscription(Clock, "/clock", leave, rclpy.qos.qos_profile_sensor_data)
        rclpy.spin(node)
        """,
    )
    assert played.pace.paced_ticks == 0


TOLD = {"kept": {"/told std_msgs/msg/String": 1}, "endpoints": [HELLO | {"topic": "/told"}]}
HEARS = {"asked": {"/told std_msgs/msg/String": 1}, "endpoints": [HELLO | {"topic": "/told", "kind": "subscription"}]}


class OneHasGone(Leaving):
    """Three processes: one has gone, one has published a message that is kept, the third asks for that."""

    def __init__(self, gone):
        super().__init__(-1, ends)
        self.participants, self.theirs = [], []
        for number, reports in enumerate((gone, [TOLD], [HEARS])):
            ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
            self.participants.append(Participant(ours, number, lambda *_: None))
            self.theirs.append(theirs)
            for each in reports:
                self.report(number, **each)
        self.theirs[0].shutdown(socket.SHUT_RDWR)
        self.participants[0].read()
        self.clock = SimpleNamespace(now=lambda: 0.0)

    def report(self, number, **what):
        self.theirs[number].send(json.dumps(REPORT | {"holding": True} | what).encode())
        self.participants[number].read()

    @property
    def followed(self):
        return [each for each in self.participants if each.progress and not each.gone]

    @property
    def endpoints(self):
        return tuple(e for each in self.followed for e in each.progress.endpoints)

    @property
    def layout(self):
        return tuple(id(each.progress and each.progress.endpoints) for each in self.participants)

    def publishes(self, topic):
        return None

    def close(self):
        for each in (*self.participants, *self.theirs):
            each.close()


@pytest.mark.parametrize(
    ("gone", "is_lost"),
    [
        pytest.param([], False, id="no node"),
        pytest.param([{"endpoints": [HELLO]}], False, id="another topic"),
        pytest.param([HEARS, {}], True, id="the same topic"),  # perhaps the message was for the one that has gone
    ],
)
def test_what_is_on_its_way_to_somebody_who_is_there_is_waited_for(monkeypatch, gone, is_lost):
    processes = OneHasGone(gone)
    try:
        pace = LockStep(processes, processes, holding=True)
        monkeypatch.setattr(pace, "await_matches", lambda: None)
        assert pace._settled() is is_lost
        processes.report(1, **TOLD | {"endpoints": [HELLO | {"topic": "/told"}] * 2})
        assert pace._settled() is is_lost, "the layout has changed"
        processes.report(2, taken={"/told": 1}, **HEARS)
        assert pace._settled()
    finally:
        processes.close()


@pytest.mark.parametrize(("gone", "is_lost"), [([], False), ([{"endpoints": [HELLO]}], True)])
def test_a_request_is_not_lost_because_a_process_without_a_node_has_ended(monkeypatch, gone, is_lost):
    """One with a node may have been the server, which no endpoint tells."""
    processes = OneHasGone(gone)
    try:
        pace = LockStep(processes, processes, holding=True)
        monkeypatch.setattr(pace, "await_matches", lambda: None)
        processes.report(1, endpoints=[HELLO], delivered={"request /told": 1})
        processes.report(2, endpoints=[HELLO])
        assert pace._settled() is is_lost
        processes.report(2, endpoints=[HELLO], taken={"request /told": 1})
        assert pace._settled()
    finally:
        processes.close()
