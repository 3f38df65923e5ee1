"""Directions whose two arguments are exchanged: what is published as x and as y says which is which."""

import pytest

from gz_course.grader.feedback.suspects import suspects

NODE = """
class A:
    def on_pictures(self, image, depth):
        for ahead, left in self.seen:
            point = PointStamped()
            point.point.x, point.point.y = ahead, left
            self.remember({given})

    def remember(self, {parameters}):
        {code}
"""


@pytest.mark.parametrize(
    ("given", "parameters", "code", "words"),
    [
        (
            "ahead, left",
            "ahead, left",
            "a = atan2(ahead, left)",
            "takes y first, what is to the left, and that is left here: atan2(left, ahead)",
        ),
        ("ahead + 0.12, left", "forward, side", "a = math.atan2(forward, side)", "atan2(side, forward)"),
        ("ahead, left", "depth, off", "f = depth + 0.12; a = np.arctan2(f, off)", "arctan2(off, f)"),
        ("ahead, left", "ahead, left", "a = atan2(left, ahead + 0.12)", ""),
        ("ahead, left", "forward, side", "a = atan2(side, forward)", ""),
        ("left, ahead", "first, second", "a = atan2(first, second)", ""),
        ("ahead, left", "ahead, left", "a = atan2(self.x, left)", ""),
        (
            "ahead, left",
            "a, b",
            "x, y = a * sin(h) - b * cos(h), a * cos(h) + b * sin(h)",
            "for x, it is a * cos - b * sin",
        ),
        ("ahead, left", "a, b", "x, y = a * cos(h) + b * sin(h), b * cos(h) - a * sin(h)", "turn the wrong way"),
        ("ahead, left", "a, b", "x, y = a * cos(h) - b * sin(h), a * sin(h) + b * cos(h)", ""),
        ("ahead, left", "a, b", "y, x = b * cos(h) + sin(h) * a, -b * sin(h) + a * cos(h)", ""),
    ],
)
def test_exchanged_directions(given, parameters, code, words):
    places = suspects(NODE.format(given=given, parameters=parameters, code=code).encode())
    said = [each["said"] for each in places if each["about"] == "axes"]
    assert bool(said) == bool(words) and all(words in each for each in said), places
