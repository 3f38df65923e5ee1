"""A timer that is made twice: two calls, a method called twice, a callback that makes its own."""

import pytest

from gz_course.grader.lint.repeated_timers import repeated_timers

RIGHT = """\
class Greeter(Node):
    def __init__(self):
        self.start()
        {init}

    def start(self):
        self.timer = self.create_timer(1.0, self.greet)

    def greet(self):
        self.timer.cancel()
        {greet}
"""


@pytest.mark.parametrize(
    ("init", "greet", "words"),
    [
        ("self.again = self.create_timer(timer_period_sec=2.0, callback=self.greet)", "pass", "beside that of line"),
        ("self.start()", "pass", "lines 3 and 4 call it"),
        ("pass", "self.timer = self.create_timer(1.0, self.greet)", "each call of greet makes another timer"),
        ("self.other = self.create_timer(1.0, self.wave)", "pass", ""),
        ("pass", "self.timer = self.create_timer(1.0, self.wave)", ""),
    ],
)
def test_a_timer_that_is_made_again(init, greet, words):
    found = repeated_timers(RIGHT.format(init=init, greet=greet).encode())
    assert any(words in each["said"] for each in found) if words else not found
