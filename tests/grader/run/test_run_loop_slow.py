"""A run that takes long is ended if that is the student's doing; a busy machine costs nobody a point."""

from types import SimpleNamespace

import pytest

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.run.pace.lockstep import LONG_WAIT, LockStep
from gz_course.grader.run.run_loop import MACHINES_FACTOR, STUDENTS_SHARE, WALL_FACTOR, WALL_GRACE, RunLoop

DURATION = 5.0
LIMIT = WALL_FACTOR * DURATION + WALL_GRACE
SHARE = STUDENTS_SHARE * LIMIT


@pytest.fixture
def slow():
    """Whether the student is found slow after so much wall time, given processor time and long waits."""

    def call(wall, cpu=0.0, held=0.0):
        stage = object.__new__(RunLoop)
        stage._exercise = SimpleNamespace(duration=DURATION)
        stage._world = SimpleNamespace(sim_time_ns=1_500_000_000)
        stage._pace = SimpleNamespace(held_seconds=held)
        stage._processes = SimpleNamespace(cpu_seconds=lambda: cpu)
        return stage._student_is_slow(wall)

    return call


def test_who_computes_or_blocks_is_slow(slow):
    assert slow(LIMIT, cpu=SHARE + 0.1)
    assert slow(LIMIT, held=SHARE + 0.1)


def test_who_waits_for_a_busy_machine_is_not(slow):
    assert not slow(LIMIT, cpu=SHARE - 0.1, held=SHARE - 0.1)
    assert not slow(0.9 * MACHINES_FACTOR * LIMIT)


def test_a_machine_that_gets_nowhere_is_our_fault(slow):
    with pytest.raises(InfrastructureError, match=r"too busy: 1\.50 s of simulated time took \d+ s; grade again"):
        slow(MACHINES_FACTOR * LIMIT + 1)


@pytest.mark.parametrize(("waited", "held"), [(LONG_WAIT * 0.9, 0.0), (LONG_WAIT * 2, LONG_WAIT * 2)])
def test_only_long_waits_count(monkeypatch, waited, held):
    now = iter([10.0, 10.0 + waited])
    monkeypatch.setattr("gz_course.grader.run.pace.lockstep.time", SimpleNamespace(monotonic=lambda: next(now)))
    pace = object.__new__(LockStep)
    pace.held_seconds = 0.0
    pace._await_settled_until = lambda deadline: deadline > 10.0
    assert pace._await_settled() is True
    assert pace.held_seconds == pytest.approx(held)
