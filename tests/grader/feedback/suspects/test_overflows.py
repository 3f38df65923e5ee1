"""Channels of 8 bits that are multiplied as they are are found; converted ones are not."""

import pytest

from gz_course.grader.feedback.suspects import suspects

FILE = """\
def on_picture(self, image):
    colours = {picture}
    red, green, blue = colours[:, :, 0], colours[:, :, 1], colours[:, :, 2]
    is_red = {rule}
"""
PICTURE = "self.bridge.imgmsg_to_cv2(image, 'rgb8')"


@pytest.mark.parametrize(
    ("picture", "rule", "words"),
    [
        (PICTURE, "(red > 100) & (red > 2 * green)", "2 * green overflows"),
        (PICTURE, "red - green > 50", "red - green overflows"),
        (PICTURE, "colours[:, :, 0] > 2 * colours[:, :, 1]", "2 * colours[:, :, 1] overflows"),
        (PICTURE + ".astype(int)", "red > 2 * green", ""),
        (PICTURE, "(red > 100) & (green < 60)", ""),
        (PICTURE, "red > 2.0 * green", ""),
    ],
)
def test_overflows(picture, rule, words):
    found = suspects(FILE.format(picture=picture, rule=rule).encode())
    said = [each["said"] for each in found if each["about"] == "overflow"]
    assert len(said) == bool(words) and all(words in each for each in said), said
