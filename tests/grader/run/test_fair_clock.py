"""A clock that shows for how long processes could act, whatever else the machine does."""

import os
import subprocess
import sys
import threading
import time

import pytest

from gz_course.grader.run import fair_clock
from gz_course.grader.run.fair_clock import FairClock, Patience
from gz_course.tests.own_time import OwnTime


@pytest.fixture
def clock(monkeypatch):
    """A clock of one thread: each look gives the wall time, and what it ran and waited in total [s].

    `ready_at` are the times at which it is ready to run.
    """

    def call(*looks, ready_at=()):
        steps = iter([*looks])
        wall = [0.0]
        monkeypatch.setattr(fair_clock, "time", OwnTime(monotonic=lambda: wall[0]))

        def threads(_):
            wall[0], ran, waited = next(steps)
            return [((1, 1), (round(ran * 1e9), round(waited * 1e9)))]

        monkeypatch.setattr(fair_clock, "_threads", threads)
        monkeypatch.setattr(fair_clock, "_ready_to_run", lambda keys: set(keys) if wall[0] in ready_at else set())
        made = FairClock(lambda: [1])
        monkeypatch.setattr(fair_clock, "SAMPLE", 0.0)
        return made

    return call


@pytest.mark.parametrize(
    ("ran", "waited", "shown", "idle"),
    [(0.0, 0.0, 2.0, 2.0), (2.0, 0.0, 2.0, 0.0), (0.0, 2.0, 0.0, 0.0), (0.5, 1.5, 0.5, 0.0), (0.5, 1.0, 1.0, 0.5)],
)
def test_it_advances_while_a_process_sleeps_or_computes(clock, ran, waited, shown, idle):
    made = clock((0.0, 7.0, 9.0), (2.0, 7.0 + ran, 9.0 + waited), (2.0, 7.0 + ran, 9.0 + waited))
    made.now()
    assert made.now() == pytest.approx(shown)
    assert made.idle() == pytest.approx(idle)


def test_a_delay_that_is_known_late_is_subtracted_later(clock):
    made = clock((0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (1.0, 0.0, 1.0), (1.5, 0.0, 1.0))
    shown = [made.now() for _ in range(4)]
    assert shown == pytest.approx([0.0, 0.5, 0.5, 0.5])


def test_a_long_wait_is_subtracted_while_it_lasts_and_only_once(clock):
    looks = [(at, 0.0, 0.0) for at in (0.0, 1.0, 2.0, 3.0)] + [(4.0, 0.5, 3.5), (5.0, 0.5, 3.5), (6.0, 0.5, 3.5)]
    made = clock(*looks, ready_at=(1.0, 2.0, 3.0))
    assert [made.now() for _ in looks] == pytest.approx([0.0, 0.0, 0.0, 0.0, 0.5, 1.5, 2.5])
    assert made._delayed == pytest.approx(3.5)


def test_who_is_ready_to_run_is_asked_of_the_kernel(monkeypatch):
    mine = (os.getpid(), threading.get_native_id())
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set())
    assert fair_clock._ready_to_run([mine, (mine[0], 1 << 22)]) == {mine}
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: range(1 << 20))
    assert fair_clock._ready_to_run([mine]) == set(), "each has a processor"


def test_a_thread_apart_may_wait_for_a_processor_while_the_others_sleep(monkeypatch):
    """On a busy machine, who looks again and again waits all the time; that says nothing about whom it waits for."""
    wall, mine = [0.0], (os.getpid(), 7)
    monkeypatch.setattr(fair_clock, "time", OwnTime(monotonic=lambda: wall[0]))
    monkeypatch.setattr(fair_clock, "SAMPLE", 0.0)
    monkeypatch.setattr(fair_clock, "_threads", lambda _: [(mine, (0, round(wall[0] * 1e9))), ((1, 1), (0, 0))])
    all_of_them, but_mine = FairClock(lambda: [1]), FairClock(lambda: [1], apart=7)
    for _ in range(5):
        all_of_them.now(), but_mine.now()
        wall[0] += 1.0
    assert (all_of_them.now(), but_mine.now()) == (0.0, 5.0)


def test_beside_busy_processes_a_busy_process_gets_its_time():
    """Two processes that share one processor have half of the time each, and their clocks show that."""
    processor = {min(os.sched_getaffinity(0))}
    loop = [sys.executable, "-I", "-S", "-c", "while True: pass"]
    busy = [subprocess.Popen(loop) for _ in range(3)]
    try:
        for each in busy:
            os.sched_setaffinity(each.pid, processor)
        clock = FairClock(lambda: [busy[0].pid])
        clock.now()
        began = os.times().elapsed
        while clock.now() < 0.5:
            time.sleep(0.02)
        assert os.times().elapsed - began > 1.0
    finally:
        for each in busy:
            each.kill()
            each.wait()


def test_patience_ends(clock):
    made = clock(*((at / 10, 0.0, 0.0) for at in range(100)))
    patience = Patience(made, 2.0)
    looks = 0
    while not patience.over():
        fair_clock.time.monotonic()
        made.now()
        looks += 1
    assert looks <= 21
