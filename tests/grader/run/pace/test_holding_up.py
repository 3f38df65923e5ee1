"""Who is waited for holds the run up, also on a busy machine; who has come to rest does not, seen late or not."""

from types import SimpleNamespace

import pytest

from gz_course.grader.run.fair_clock import FairClock
from gz_course.grader.run.pace.lockstep import LockStep
from gz_course.grader.run.pace.real_time import PATIENCE
from gz_course.grader.run.processes.progress import Progress


class Worker:
    """A process that comes to rest after some looks at it, each of which takes a second of its clock."""

    gone = starting = waiting_for_release = wants_answer = waits_for_log = False
    logged, running, participants, endpoints, layout = 0, True, (), (), (1,)

    def __init__(self, looks):
        self.looks, self.seconds = looks, 0.0
        self.participants = self.followed = [self]
        self.clock_but_mine = SimpleNamespace(now=lambda: self.seconds)
        # That of all stands still, because who looks waits for a processor all the time.
        self.clock = SimpleNamespace(now=lambda: 0.0, delayed=lambda: 0.0)

    @property
    def progress(self):
        return Progress(idle=self.seconds >= self.looks)

    def wait(self, seconds):
        self.seconds += 1.0

    def tell(self, order): ...


@pytest.fixture
def held_up(monkeypatch):
    """Wait for a worker; how long it has held the run up, and whether it was given up."""
    monkeypatch.setattr("gz_course.grader.run.fair_clock.SAMPLE", 0.0)

    def call(looks):
        worker = Worker(looks)
        ros = SimpleNamespace(received={}, pump=lambda: None, listens=lambda topic: None, matched=lambda *of: 1)
        ros.keeps, ros.offered = lambda topic: 0, {}
        pace = LockStep(worker, ros)
        pace._layout, pace._participants = worker.layout, [worker]
        pace.send("/clock", SimpleNamespace(publish=lambda message: None), "tick", -1)
        pace.settle()
        return pace.held_up, pace._failures

    return call


def test_who_is_at_work_holds_the_run_up_also_on_a_busy_machine(held_up):
    assert held_up(3) == (2.0, 0)


def test_who_has_come_to_rest_meanwhile_is_not_judged_by_when_it_was_seen(held_up):
    assert held_up(1) == (0.0, 0)


def test_who_is_at_work_for_too_long_is_not_waited_for(held_up):
    seconds, failures = held_up(1000)
    assert failures == 1 and PATIENCE < seconds <= PATIENCE + 1


def test_the_clock_of_all_but_who_waits_follows_all_others():
    assert FairClock(list, apart=1).now() == 0.0
