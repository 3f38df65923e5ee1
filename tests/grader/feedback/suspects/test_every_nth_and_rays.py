"""Suspects in counted calls, and indices of ranges that choose no ray."""

import ast

import pytest

from gz_course.grader.feedback.suspects.memory import old_values
from gz_course.grader.feedback.suspects.sensing import rays

COUNTS = """
class A:
    def on_scan(self, scan):
        self.n += 1
        if {}:
            {}self.maps.publish(grid)
"""


@pytest.mark.parametrize(
    ("test", "first", "number"),
    [
        ("self.n % 10 == 0", "", 1),
        ("not self.n", "", 0),
        ("self.n >= 10", "self.n = 0; ", 1),
        ("self.n >= 10", "", 0),
        ("self.k % 10 == 0", "", 0),
    ],
)
def test_a_counter_of_calls_that_lets_few_publish(test, first, number):
    found = list(old_values.every_nth_call(ast.parse(COUNTS.format(test, first))))
    assert [said.endswith("only one in 10 calls of on_scan publish") for _, _, said in found] == [True] * number


@pytest.mark.parametrize(
    ("index", "number"),
    [(":, None", 0), ("None, :", 0), ("None", 0), ("..., None", 0), ("::-1", 0), ("0", 1), ("5:9", 1)],
)
def test_an_added_axis_chooses_no_ray(index, number):
    assert len(list(rays.by_number(ast.parse(f"x = scan.ranges[{index}]")))) == number
