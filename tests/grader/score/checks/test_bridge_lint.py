"""`bridge_lint`: errors and warnings fail it, advice does not."""

import pytest

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.kinds.bridge import read
from gz_course.grader.score.check import check_kinds
from gz_course.sim.bridge.ros_gz_bridge import type_pairs

ENTRY = """
- ros_topic_name: /scan
  gz_topic_name: /lidar
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
"""
TRANSFORMS = """
- ros_topic_name: /tf
  gz_topic_name: /pose
  ros_type_name: tf2_msgs/msg/TFMessage
  gz_type_name: gz.msgs.Pose_V
"""
COUNTS = {"to_ros": 9, "to_gz": 0, "publisher_qos": None, "subscription_qos": None}
BRIDGE = dict.fromkeys(("source", "ros_topic", "ros_type", "gz_topic", "gz_type", "direction"), "") | COUNTS


@pytest.fixture
def find(record):
    """What the check finds in a file whose only bridge has carried messages."""

    def call(text):
        found = [
            {"place": each.place, "sentence": each.sentence, "warning": each.warning, "advice": each.advice}
            for each in read("bridge.yaml", text.encode()).findings
        ]
        table = Table({"carried": 1}, "check 'it'", "parameter")
        return check_kinds()["bridge_lint"](record(facts={"lint": found, "bridges": [BRIDGE]}), table)

    return call


def test_a_clean_file_passes(find):
    finding = find(ENTRY + "  direction: GZ_TO_ROS\n")
    assert (finding.passed, finding.measured) == (True, "nothing found")


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ("  direction: GZ_TO_ROS\n  subscriber_queue: 1\n", "'subscriber_queue' changes nothing here"),
        (f"  direction: GZ_TO_ROS\n{TRANSFORMS}  direction: GZ_TO_ROS\n", "tf2_msgs, which is not installed"),
    ],
    ids=["a key that changes nothing", "a package that is not installed"],
)
def test_advice_is_told_and_costs_nothing(find, more, words, monkeypatch):
    monkeypatch.setattr(type_pairs, "_installed", lambda package: package != "tf2_msgs")
    finding = find(ENTRY + more)
    assert finding.passed
    assert finding.measured.startswith("no error and no warning; advice, for no points: bridge.yaml, line ")
    assert words in finding.measured


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ("", "warning in bridge.yaml, line 2: gz.msgs.LaserScan is what Gazebo publishes"),
        ("  directon: x\n", "error in "),
    ],
    ids=["a warning", "an error"],
)
def test_errors_and_warnings_cost_the_points(find, more, words):
    finding = find(ENTRY + more)
    assert not finding.passed and finding.measured.startswith(words)
