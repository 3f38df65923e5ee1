"""Loops over the rays of a scan that end at the first one that is not valid."""

import ast

import pytest

from gz_course.grader.feedback.slips.nodes.scan_callbacks import ended_by_an_invalid_ray

LOOP = """
def on_scan(self, scan):
    for number, distance in enumerate(scan.ranges):
        if {}:
            {}
        self.draw(number, distance)
"""


@pytest.mark.parametrize(
    ("test", "leaves", "number"),
    [
        ("math.isinf(distance)", "return", 1),
        ("not math.isfinite(distance)", "break", 1),
        ("distance == float('inf')", "return", 1),
        ("math.isinf(distance)", "continue", 0),
        ("math.isfinite(distance)", "break", 0),
        ("not math.isinf(distance)", "break", 0),
        ("not np.isnan(distance)", "return", 0),
    ],
)
def test_a_ray_that_ends_the_loop(test, leaves, number):
    assert len(list(ended_by_an_invalid_ray(ast.parse(LOOP.format(test, leaves))))) == number
