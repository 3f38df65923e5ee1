"""Errors without a text of their own get words."""

import pytest

from gz_course.sim.error_text import named
from gz_course.sim.ros.launch.substitutions.command import _without_traces


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (MemoryError(), "MemoryError: it needs more memory than there is"),
        (ValueError(), "ValueError"),
        (ValueError("a\n b"), "ValueError: a b"),
    ],
)
def test_a_name_and_words(error, said):
    assert named(error) == said


def test_a_program_that_says_error_and_no_more():
    assert _without_traces("error: \n") == "error: it gives no reason, as a program does that runs out of memory"
    assert _without_traces("error: no such file\n") == "error: no such file"
