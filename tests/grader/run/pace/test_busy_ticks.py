"""A tick of wall time is prolonged by what others take from the nodes, but not without end."""

from types import SimpleNamespace

import pytest

from gz_course.grader.run.pace import real_time
from gz_course.grader.run.pace.real_time import LONGEST_TICK, RealTime

TICK = 0.01


@pytest.mark.parametrize(
    ("share", "longest"), [(0.0, 1.1), (0.5, 2.1), (0.97, LONGEST_TICK + 1), (1.0, LONGEST_TICK + 1)]
)
def test_ticks_on_a_machine_that_takes_a_share_of_the_time(monkeypatch, share, longest):
    """Each round of waiting takes what was asked for; a share of all time is delay."""
    now = 0.0

    def wait(seconds):
        nonlocal now
        now += seconds

    clock = SimpleNamespace(delayed=lambda: share * now, now=lambda: now)
    monkeypatch.setattr(real_time, "time", SimpleNamespace(monotonic=lambda: now, sleep=wait))
    processes = SimpleNamespace(clock=clock, running=True, wait=wait, participants=[])
    pace = RealTime(processes, SimpleNamespace(pump=lambda: None))
    pace.everything_arrived = lambda: True
    took = []
    for _ in range(200):
        began = now
        pace.close_tick(TICK)
        wait(TICK / 10)  # the world is computed
        took.append((now - began) / TICK)
    assert max(took) <= longest
    assert min(took[1:]) >= 1.0 or share == 0.0
