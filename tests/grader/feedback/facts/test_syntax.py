"""What cannot be parsed or looked at has no places: it never ends a grading."""

import ast

import pytest

from gz_course.grader.feedback.facts.clocks import time_reckoning, wall_clock
from gz_course.grader.feedback.facts.syntax import parsed, walk
from gz_course.grader.feedback.facts.whole_numbers import whole_numbers
from gz_course.grader.feedback.slips import slips

LOOKS = [slips, time_reckoning, wall_clock, lambda content: whole_numbers(content, {"x": {"Point"}})]
CHAIN = b"x" + b".a" * 2000


@pytest.mark.parametrize(
    "content",
    [
        CHAIN + b"()\n",
        b"def f():\n    global t\n    t += 1\n    y = s" + CHAIN + b"[0]\n    " + CHAIN + b" = " + CHAIN + b" + 1\n",
        b"a.x = " + b"-" * 5000 + b"1\n",
        b"def\n",
        b"\xff\x00",
    ],
)
@pytest.mark.parametrize("look", LOOKS)
def test_what_python_gives_up_has_no_places(look, content):
    assert look(content) == []


def test_a_file_that_is_far_longer_than_any_solution_has_no_places():
    slip = b"import rclpy\nrclpy.spin\n"
    assert slips(slip)
    assert slips(slip + b"x = 1\n" * 20_000) == []
    nested = b"\n".join(b" " * depth + b"def f(self):" for depth in range(90)) + b"\n"
    assert slips(slip + nested + (b" " * 90 + b"self.f(1)\n") * 200) == []


def test_a_tree_is_walked_once_and_stays_as_it_is():
    source = "def f(x):\n    return [x + 1 for x in (1, 2)]"
    tree = ast.parse(source)
    assert list(walk(tree)) == list(ast.walk(tree))
    assert walk(tree) is walk(tree)
    assert ast.unparse(tree) == source


def test_a_file_is_parsed_once_for_all_looks():
    assert parsed(b"a = 1") is parsed(b"a = 1")
    assert parsed(b"def\n").body == []
