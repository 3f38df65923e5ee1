"""Numbers that are no floats of Python, as they arrive in a message."""

import numpy as np
import pytest

from gz_course.grader.score.lost_numbers import lost_number

FACTS = {"listened": {"/cmd_vel": "geometry_msgs/msg/Twist"}}


def arrived(bits):
    return float(np.array([bits], dtype=np.int64).view(np.float64)[0])


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (arrived(1), "a whole number"),
        (arrived(int(np.array([0.7], dtype=np.float32).view(np.uint32)[0])), "NumPy's type float32 (0.7)"),
    ],
)
def test_the_field_is_named(record, value, words):
    said = lost_number(record({"topics/cmd_vel/linear/x": [(0.1, 0.0), (0.2, value)]}, facts=FACTS))
    assert said.startswith("linear.x of what you publish on /cmd_vel") and words in said


def test_small_numbers_are_numbers(record):
    signals = {"topics/cmd_vel/linear/x": [(0.1, 1e-12), (0.2, -0.5)], "truth/robot/x": [(0.1, arrived(1))]}
    assert lost_number(record(signals, facts=FACTS)) == ""


def test_a_place_that_is_known_from_the_file_is_not_said_twice(record):
    signals = {"topics/cmd_vel/linear/x": [(0.1, arrived(1))]}
    assert lost_number(record(signals, facts=FACTS | {"whole_numbers": [{"line": 3}]})) == ""
