"""Whose fault an error is decides the exit code."""

import pytest

from gz_course.grader.errors import CourseError, InfrastructureError, ManifestError, UsageError


@pytest.mark.parametrize(
    ("error", "code"), [(CourseError, 3), (UsageError, 2), (ManifestError, 3), (InfrastructureError, 3)]
)
def test_exit_codes(error, code):
    assert issubclass(error, CourseError)
    assert error("x").exit_code == code
