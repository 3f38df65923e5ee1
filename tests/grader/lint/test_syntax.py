"""What cannot be parsed or looked at has no places: it never ends a grading."""

import pytest

from gz_course.grader.lint.slips import slips
from gz_course.grader.lint.time_reckoning import time_reckoning
from gz_course.grader.lint.wall_clock import wall_clock
from gz_course.grader.lint.whole_numbers import whole_numbers

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
