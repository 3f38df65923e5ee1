"""A timer that is made twice by a method that is called twice, and a loop that publishes."""

import pytest

from gz_course.grader.feedback.facts.publishing import repetitions

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
        ("self.start()", "pass", "lines 3 and 4 call it"),
        ("self.other = self.create_timer(1.0, self.wave)", "pass", ""),
        ("pass", "self.timer = self.create_timer(1.0, self.wave)", ""),
    ],
)
def test_a_timer_that_is_made_again(init, greet, words):
    found = repetitions(RIGHT.format(init=init, greet=greet).encode())
    assert any(words in each["said"] for each in found) if words else not found


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("while rclpy.ok():\n    time.sleep(1.0)\n    p.publish(a)", True),
        ("for i in range(3):\n    p.publish(a)", True),
        ("while True:\n    p.publish(a)\n    break", False),
        ("while rclpy.ok():\n    rclpy.spin_once(node)", False),
    ],
)
def test_a_loop_that_publishes(text, named):
    assert bool(repetitions(text.encode())) == named
