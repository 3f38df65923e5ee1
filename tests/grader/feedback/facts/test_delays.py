"""Periods of timers and lengths of sleeps, as far as they are constants of the file."""

import pytest

from gz_course.grader.feedback.facts.publishing import delays

TIMER = {"line": 1, "kind": "timer", "seconds": 0.5, "rounds": 1}


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("self.create_timer(0.5, self.tick)", [TIMER]),
        ("self.create_timer(timer_period_sec=PERIOD, callback=tick)\nPERIOD = 0.5", [TIMER]),
        ("for i in range(3):\n    time.sleep(0.5)", [TIMER | {"line": 2, "kind": "sleep", "rounds": 3}]),
        ("while True:\n    time.sleep(0.5)", []),
        ("for i in range(3):\n    time.sleep(0.5)\n    if done(): break", []),
        ("self.create_timer(0.5, self.tick)\ntime.sleep(wait())", []),
    ],
)
def test_delays(text, found):
    assert delays(text.encode()) == found
