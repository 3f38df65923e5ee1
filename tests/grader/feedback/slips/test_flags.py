"""A flag that only the lines which it keeps back would set, and flags that others set."""

import pytest

from gz_course.grader.feedback.slips import slips

TEXT = """\
class Greeter(Node):
    def __init__(self):
        super().__init__("greeter")
        self.open = False
        self.create_timer(1.0, self.greet)

    def greet(self):
        {lines}

    def hear(self, message):
        {hear}
"""


def said(lines, hear="pass"):
    text = TEXT.format(lines="\n        ".join(lines), hear=hear)
    return [
        place["said"]
        for place in slips(text.encode())
        if "never runs: self.open is False from the start" in place["said"]
    ]


@pytest.mark.parametrize(
    "lines",
    [
        ("if not self.open:", "    return", "self.open = True", "self.publisher.publish(a)"),
        ("if self.open:", "    self.publisher.publish(a)", "    self.open = True"),
    ],
)
def test_a_flag_that_nothing_else_sets_is_named(lines):
    assert said(lines)
    assert not said(lines, "self.open = True"), "a callback sets it"
    assert not said(lines, "self.open, self.n = message.open, 1"), "a callback sets it, with others"


@pytest.mark.parametrize(
    "lines",
    [
        ("if self.open:", "    return", "self.open = True"),
        ("if not self.open:", "    self.open = True", "    self.publisher.publish(a)"),
        ("if self.open:", "    self.publisher.publish(a)", "self.open = True"),
    ],
)
def test_a_flag_that_opens_is_none(lines):
    assert not said(lines)
