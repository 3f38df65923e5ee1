"""Limits that are exchanged are found, and right ones are not."""

import pytest

from gz_course.grader.feedback.slips import slips

FILE = """\
MOST = 1.5


def limited(value, most, least):
    return {code}
"""


@pytest.mark.parametrize(
    ("code", "words"),
    [
        ("max(-most, min(most, value))", ""),
        ("min(most, max(-most, value))", ""),
        ("min(most, max(least, value))", ""),
        ("np.clip(value, -most, most)", ""),
        ("min(-most, max(most, value))", "is always -most, whatever the value is"),
        ("max(MOST, min(value, -MOST))", "is always MOST, whatever the value is"),
        ("max(0.5, min(0.1, value))", "is always 0.5, whatever the value is"),
        ("np.clip(value, 1.5, -1.5)", "limits exchanged"),
    ],
)
def test_exchanged_limits(code, words):
    said = [place["said"] for place in slips(FILE.format(code=code).encode())]
    assert len(said) == bool(words) and all(words in each for each in said), said


def test_pi_that_is_divided_without_remainder_is_found():
    (said,) = [each["said"] for each in slips(b"import math\nleft = -math.pi // 2\nright = math.pi / 2\n")]
    assert said == "-math.pi // 2 is -2, because // rounds down: -math.pi / 2 is -1.57"
