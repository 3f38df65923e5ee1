"""Applies one kind of check to a recording made by hand."""

import pytest

from gz_course.grader.exercise import CheckSpec
from gz_course.grader.score.check import perform


@pytest.fixture
def found():
    """`found("within", recording, start=1.0, ...)`: what a check of this kind finds."""

    def call(kind, recording, folder=None, **parameters):
        return perform(CheckSpec("it", "A title", 10, kind, ("A hint.",), parameters), recording, folder)

    return call
