"""Differences that are always 0, sums of cosines and sines that turn nothing, and texts compared with `is`."""

import pytest

from gz_course.grader.feedback.slips import slips

FILE = """\
from math import cos, sin

LEFT, RIGHT = "left", "right"


class Node:
    def on_imu(self, message):
        now = message.time
        {early}
        passed = now - self.last
        {late}
        h = self.heading
        {rotation}
        return passed, x, y
"""
X, Y = "x = ahead * cos(h) - left * sin(h)", "y = ahead * sin(h) + left * cos(h)"
RIGHT = {"early": "pass", "late": "self.last = now", "rotation": f"{X}\n        {Y}"}


def said(**changed):
    return [place["said"] for place in slips(FILE.format(**RIGHT | changed).encode())]


@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"early": "if self.last is None:\n            self.last = now"},
        {"early": "self.last = self.last or now"},
        {"early": "before = now\n        now = message.stamp"},
        {"rotation": "x, y = cos(h) * ahead - sin(h) * left + self.x, sin(h) * ahead + cos(h) * left + self.y"},
        {"rotation": "c, s = cos(h), sin(h)\n        x = c * ahead + s * left\n        y = -s * ahead + c * left"},
        {"rotation": f"x = 0.0\n        {X}\n        {X}\n        {Y}\n        {Y}"},
        {"rotation": "x = ahead * cos(h)\n        y = left * sin(h)"},
    ],
)
def test_right_ways(changed):
    assert said(**changed) == []


@pytest.mark.parametrize(
    "early",
    [
        "self.last = now",
        "self.last, before = now, self.last",
        "if self.ready:\n            pass\n        self.last = now",
    ],
)
def test_a_difference_that_is_always_0(early):
    (words,) = said(early=early, late="pass")
    assert words.startswith("now - self.last is always 0, because line ")


def test_a_difference_in_a_function_that_is_passed_the_value_is_always_0():
    change = """
class Node:
    def on_scan(self, scan):
        error = scan.near - 1
        {}
        self.turn(self.rate({}))
        self.last = error

    def rate(self, e):
        return self.last - e
"""
    (place,) = slips(change.format("self.last = error", "error").encode())
    assert "self.last - e is always 0, because line 5 has made self.last the same as e" in place["said"]
    assert (
        slips(change.format("pass", "error").encode()) == slips(change.format("self.last = error", "2").encode()) == []
    )


@pytest.mark.parametrize(
    "rotation",
    [
        f"{X}\n        y = ahead * cos(h) + left * sin(h)",
        f"{X}\n        y = left * cos(h) - ahead * sin(h)",
        "c, s = cos(h), sin(h)\n        x, y = c * ahead - s * left, s * ahead - c * left",
    ],
)
def test_what_turns_no_point(rotation):
    (words,) = said(rotation=rotation)
    assert "do not turn a point: it is ahead * cos - left * sin for x" in words


def test_constants_assigned_together_are_no_objects_to_be_recognised():
    text = FILE.format(**RIGHT) + "\n    def sign(self):\n        return 1 if self.side is LEFT else -1\n"
    assert "self.side is LEFT: is asks whether both are the same object" in slips(text.encode())[0]["said"]


@pytest.mark.parametrize(
    "more",
    [
        "\n\nclass Side(enum.Enum):\n    LEFT = 1\n    RIGHT = 2\n",
        "\n\nclass Side(Flag):\n    LEFT, RIGHT = 1, 2\n",
        "\n\nLEFT = 'left'\nself.side = LEFT\n",
    ],
)
def test_one_object_with_two_names_is_recognised(more):
    file = FILE.format(**RIGHT).replace("LEFT", "PORT")
    text = f"{file}\n    def sign(self):\n        return 1 if self.side is Side.LEFT else -1\n{more}"
    assert not [each for each in slips(text.encode()) if "same object" in each["said"]]


@pytest.mark.parametrize(
    ("second", "found"),
    [("y = x * s + y * c", True), ("y = old * s + y * c", False), ("z = x * s + y * c", False)],
)
def test_a_coordinate_that_is_changed_before_the_other_is_made(second, found):
    text = "def turned(x, y, h):\n    c, s, old = cos(h), sin(h), x\n    x = x * c - y * s\n"
    text += f"    {second}\n    return x, y\n"
    assert ["y = x * s + y * c reads x, which line 3" in each["said"] for each in slips(text.encode())] == [
        True
    ] * found
