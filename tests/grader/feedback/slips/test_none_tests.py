"""Tests for None that are the wrong way round."""

import pytest

from gz_course.grader.feedback.slips import slips

CALLBACK = """\
class Follower:
    def steer(self):
        if TEST:
            return
        x, y = self.own
        self.drive(x, y, self.front.position)
"""


@pytest.mark.parametrize(
    ("test", "found"),
    [
        ("self.own is not None", True),
        ("self.own is not None or self.done", True),
        ("not self.trail or self.front is not None", True),
        ("self.own is None or self.front is None", False),
        ("self.goal is not None", False),
        ("self.own is not None and self.front is not None", False),
    ],
)
def test_a_return_where_the_value_is_there(test, found):
    said = " ".join(each["said"] for each in slips(CALLBACK.replace("TEST", test).encode()))
    assert ("steer returns here when self." in said) == found


def test_a_value_that_is_set_first_is_right():
    text = CALLBACK.replace("TEST", "self.own is not None").replace(
        "        x, y", "        self.own = (1, 2)\n        x, y"
    )
    assert not any("returns here when" in each["said"] for each in slips(text.encode()))
