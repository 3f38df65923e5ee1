"""A run that takes long is ended if that is the student's doing; a busy machine costs nobody a point."""

from types import SimpleNamespace

import pytest

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.run.limits import MACHINES_FACTOR, time_limit
from gz_course.grader.run.run_loop import RunLoop

DURATION = 5.0
LIMIT = time_limit(DURATION)


@pytest.fixture
def loop():
    """A loop whose processes have used so much processor time [s]."""

    def call(cpu=0.0):
        made = object.__new__(RunLoop)
        made._exercise = SimpleNamespace(duration=DURATION)
        made._world = SimpleNamespace(sim_time_ns=1_500_000_000)
        made._processes = SimpleNamespace(cpu_seconds=lambda: cpu)
        made._out_of_time = False
        return made

    return call


def test_who_computes_or_is_waited_for_is_slow(loop):
    assert loop(cpu=LIMIT + 0.1)._is_slow(0.0)
    assert loop()._is_slow(LIMIT + 0.1)


def test_who_waits_for_a_busy_machine_is_not(loop):
    assert not loop(cpu=LIMIT - 0.1)._is_slow(LIMIT - 0.1)
    loop()._give_up_after(0.9 * MACHINES_FACTOR * LIMIT, 0.0)


def test_a_machine_that_gets_nowhere_is_our_fault(loop):
    with pytest.raises(InfrastructureError, match=r"too busy: 1\.50 s of simulated time took \d+ s; grade again"):
        loop(cpu=0.5 * LIMIT)._give_up_after(MACHINES_FACTOR * LIMIT + 1, 0.4 * LIMIT)


def test_who_had_processor_time_enough_is_left_to_the_watchdog(loop):
    loop(cpu=0.6 * LIMIT)._give_up_after(MACHINES_FACTOR * LIMIT + 1, 0.6 * LIMIT)
