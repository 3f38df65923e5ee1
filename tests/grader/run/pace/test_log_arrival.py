"""What was logged is waited for; what never comes holds nobody up for long, and who waits is always answered."""

from collections import Counter
from types import SimpleNamespace

import pytest

from gz_course.grader.run.agent.course_agent.rosout_counter import ROSOUT
from gz_course.grader.run.pace import log_arrival
from gz_course.grader.run.pace.log_arrival import GIVING_UP, PATIENCE, LogArrival


class Process:
    """A process that has logged so much; `told` counts confirmations."""

    gone, waits_for_log = False, True

    def __init__(self, logged):
        self.logged = logged
        self.told = 0

    def confirm_log(self):
        self.told += 1


@pytest.fixture
def clock(monkeypatch):
    now = SimpleNamespace(value=0.0)
    monkeypatch.setattr(log_arrival, "Patience", lambda clock, seconds: Waited(now, now.value + seconds))
    return now


class Waited:
    """A patience that is over at a time."""

    def __init__(self, now, end):
        self._now, self._end = now, end

    def over(self):
        return self._now.value >= self._end


def test_it_is_complete_when_all_has_come_and_who_waits_is_told(clock):
    process, received = Process(2), Counter()
    logs = LogArrival(
        SimpleNamespace(participants=[process], clock=None), SimpleNamespace(received=received, take_logs=lambda: None)
    )
    assert not logs.complete() and not process.told
    received[ROSOUT] = 2
    assert logs.complete() and process.told == 1


def test_what_is_said_and_never_comes_is_waited_for_a_few_times_and_then_never_again(clock):
    process, received = Process(0), Counter()
    logs = LogArrival(
        SimpleNamespace(participants=[process], clock=None), SimpleNamespace(received=received, take_logs=lambda: None)
    )
    for _ in range(GIVING_UP):
        process.logged += 1
        assert not logs.complete()
        clock.value += PATIENCE
        assert logs.complete() and logs.complete()
    process.logged += 1
    told = process.told
    assert logs.complete() and process.told == told + 1
