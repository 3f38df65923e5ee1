"""What our own programs wait for of the machine takes the time of the run's clock, not simulated time."""

import threading
import time
from types import SimpleNamespace

import pytest

from gz_course.grader.run.agent.course_agent import python_3
from gz_course.grader.run.agent.course_agent.thread_monitor import ThreadMonitor
from gz_course.sim import machine_clock


@pytest.fixture
def run(monkeypatch):
    """The agent's clock in place, in a process whose simulated time stands still; the run's clock is `told.now`."""
    told = SimpleNamespace(now=0.0, threads=ThreadMonitor(), at_work=[])
    threads = told.threads

    def sleep(seconds):
        told.at_work.append(threads.idle)
        told.now += seconds

    for name in ("now", "pause", "await_event"):
        monkeypatch.setattr(machine_clock, name, getattr(machine_clock, name))
    monkeypatch.setattr(python_3, "_run_time", lambda: told.now)
    monkeypatch.setattr(python_3, "sleep", sleep)
    monkeypatch.setattr(python_3, "watched", lambda: threads)
    monkeypatch.setattr(python_3, "at_work", threads.at_work)
    threads.enter(threads.expect())
    python_3.install_machine_clock()
    return told


def test_a_pause_is_work_so_that_simulated_time_stands_still(run):
    run.threads.simulated = True
    end = machine_clock.now() + 5.0
    while machine_clock.now() < end:
        machine_clock.pause(0.5)
    assert run.at_work == [False] * 10


def test_a_message_is_awaited_by_the_runs_clock_until_simulated_time_begins(run):
    waited = []

    class Event(threading.Event):
        def wait(self, seconds=None):
            waited.append(seconds)
            run.now += 0.125 if len(waited) < 6 else seconds  # at first, others want the processor
            run.threads.simulated = len(waited) >= 6
            return False

    assert not machine_clock.await_event(Event(), 10.0)
    assert waited[:6] == [python_3.SLICE] * 6
    assert waited[6:] == [pytest.approx(10.0 - 5 * 0.125 - python_3.SLICE)]


def test_what_has_come_is_not_waited_for(run):
    event, began = threading.Event(), time.monotonic()
    event.set()
    assert machine_clock.await_event(event, 0.0)
    assert run.now == 0.0 and time.monotonic() >= began


def test_the_agent_replaces_it_as_soon_as_it_is_imported():
    from gz_course.grader.run.agent.course_agent.import_hooks import AFTER

    assert AFTER[machine_clock.__name__] == ("python_3", "install_machine_clock")
