"""Whose fault an error is decides the exit code; a wrong name is answered with the nearest."""

import pytest

from gz_course.grader.errors import CourseError, InfrastructureError, ManifestError, UsageError, nearest


@pytest.mark.parametrize(
    ("error", "code"), [(CourseError, 3), (UsageError, 2), (ManifestError, 3), (InfrastructureError, 3)]
)
def test_exit_codes(error, code):
    assert issubclass(error, CourseError)
    assert error("x").exit_code == code


def test_the_nearest_name_is_offered():
    assert nearest("telepo", ["lidar", "teleop"]) == " (did you mean teleop?)"


@pytest.mark.parametrize(("name", "meant"), [("ROS_topic", "ros_topic"), ("gz_TOPIC", "gz_topic"), ("GZ", "gz")])
def test_capitals_do_not_lead_astray(name, meant):
    assert nearest(name, ["gz_topic", "ros_topic", "gz"]) == f" (did you mean {meant}?)"


def test_without_a_near_one_all_are_listed_in_order():
    assert nearest("xyz", ["teleop", "lidar"]) == " (known: lidar, teleop)"


def test_without_any_name_nothing_is_said():
    assert nearest("xyz", []) == ""
