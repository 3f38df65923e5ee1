"""The hint about a wrong name contains the nearest known name."""

import pytest

from gz_course.sim.did_you_mean import did_you_mean, nearest_name


def test_the_nearest_name_is_offered():
    assert did_you_mean("telepo", ["lidar", "teleop"]) == "; did you mean 'teleop'?"
    assert did_you_mean("telepo", ["lidar", "teleop"], listing="there are") == "; did you mean 'teleop'?"


@pytest.mark.parametrize(("name", "meant"), [("ROS_topic", "ros_topic"), ("gz_TOPIC", "gz_topic"), ("gz", "GZ")])
def test_capitals_do_not_lead_astray(name, meant):
    assert nearest_name(name, ["gz_topic", "ros_topic", "GZ"]) == meant


def test_without_a_near_one_all_are_listed_in_order():
    assert did_you_mean("xyz", ["teleop", "lidar"]) == ""
    assert did_you_mean("xyz", ["teleop", "lidar"], listing="there are") == "; there are: lidar, teleop"
    many = [f"{number:02d}" for number in range(13)]
    assert did_you_mean("xyz", many, listing="there are").endswith("10, 11, ...")


def test_the_name_itself_is_not_proposed():
    assert nearest_name("scan", ["scan"]) == "" and nearest_name("scan", ["scan", "scans"]) == "scans"
    assert did_you_mean("scan", ["scan"], listing="there are") == ""


def test_without_any_name_nothing_is_said():
    assert did_you_mean("xyz", [], listing="there are") == ""
    assert nearest_name("xyz", [], 0.0) == ""


def test_the_cutoff_says_how_much_alike():
    assert nearest_name("scan", ["laser"]) == ""
    assert nearest_name("scan", ["laser"], 0.0) == "laser"


def test_long_names_are_compared_by_their_beginning():
    assert nearest_name("a" * 10**6, ["a" * 10**6 + "b"]) == "a" * 10**6 + "b"
