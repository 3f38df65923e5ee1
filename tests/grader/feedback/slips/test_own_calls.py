"""Arguments in the wrong order are found, for functions of the file and for np.clip; right calls are not."""

import pytest

from gz_course.grader.feedback.slips import slips

FILE = """\
import numpy as np

MOST = 1.5


def limited(value, most):
    return max(-most, min(most, value))


def clamp(value, low, high):
    if value < low:
        return low
    if value > high:
        return high
    return value


def drive(speed, turn):
    publish(speed, turn)


def distance(speed, turn):
    return abs(speed - turn)


def gcd(a, b):
    return a


def steer(error, heading, limit):
    speed, turn = 0.3, 2 * (error + heading)
    {code}
"""


@pytest.mark.parametrize(
    ("code", "words"),
    [
        ("return limited(turn, MOST)", ""),
        ("return limited(0.5, limit)", ""),  # of a constant speed, by a limit that may be lower
        ("return limited(MOST, 2 * (error + heading))", "limited(value, most) (line 6)"),
        ("return limited(1.5, turn)", "does not limit turn"),
        ("return clamp(2 * (error + heading), -MOST, MOST)", ""),
        ("return clamp(-MOST, turn, MOST)", "clamp(value, low, high)"),
        ("return clamp(low=-MOST, high=MOST, value=turn)", ""),
        ("return np.clip(turn, -1.5, 1.5)", ""),
        ("return np.clip(-1.5, 1.5, turn)", "it is np.clip(value, low, high)"),
        ("return np.clip(0.5, 0.1, limit)", ""),
        ("return clamp(0.3, 0.0, limit)", ""),
        ("distance(turn, speed)", ""),
        ("drive(speed, turn)", ""),
        ("drive(turn, speed)", "has turn and speed in the wrong order"),
        ("drive(turn, 0.1)", ""),
        ("drive(turn, speed)\n    drive(speed, turn)", ""),
        ("b, a = 4, 6\n    return gcd(b, a)", ""),
    ],
)
def test_arguments_in_the_wrong_order(code, words):
    said = [place["said"] for place in slips(FILE.format(code=code).encode())]
    assert len(said) == bool(words) and all(words in each for each in said), said
