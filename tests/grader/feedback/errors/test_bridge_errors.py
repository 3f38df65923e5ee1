"""Errors of a bridge's file: what was mistaken for what."""

import pytest

from gz_course.grader.feedback.errors.launch_errors import bridge_meaning
from gz_course.grader.kinds.bridge import fault, read

ENTRY = """\
- ros_topic_name: /scan
  gz_topic_name: /lidar
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  direction: GZ_TO_ROS
"""


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("gz.msgs.LaserScan", "gz::msgs::LaserScan", "gz::msgs::LaserScan is the name of a class in C++"),
        ("sensor_msgs/msg/", "sensor_msgs::msg::", "writes it with slashes"),
        (": GZ_TO_ROS", ': "["', "[ belongs to the topics on the command line"),
        ("  direction", "direction", "a line is indented differently"),
        (ENTRY, "- /scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan\n", "how a bridge is given on the command line"),
        (": GZ_TO_ROS", ": gz_to_ros", ""),
        (": /scan", ": /scan,", "the , at the end is taken for a part of the value"),
        (": GZ_TO_ROS", ": GZ_TO_ROS;", "the ; at the end is taken for a part of the value"),
        ("gz.msgs.LaserScan", "gz.msgs.LaserScan,", "the , at the end is taken for a part of the value"),
        ("sensor_msgs/msg/LaserScan", "sensor_msgs/msg/LaserScan,", "the , at the end is taken for a part"),
        (": ", " = ", "stand a colon and a space in YAML, and no ="),
        ("  direction", "  publisher_queue: 1,\n  direction", "the , at the end is taken for a part of the value"),
        ("gz_type_name: gz.msgs.LaserScan\n", "gz_type_name: gz.msgs.Image\n", ""),
    ],
)
def test_what_was_mistaken_is_named(old, new, words):
    (error, *_) = read("bridge.yaml", ENTRY.replace(old, new).encode()).findings
    said = bridge_meaning(error.sentence)
    assert words in said and bool(words) == bool(said), error.sentence


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("bridge:\n  ros__parameters:\n    bridges: []\n", "no file of ROS parameters"),
        ("scan:\n  topic_name: /scan\n", "below keys such as 'scan'"),
        (ENTRY.replace("  ", "- "), "'ros_topic_name' and 'gz_topic_name' belong to two bridges here"),
        (ENTRY.replace(": ", ":", 1), "a space is missing after the colon in line 1"),
        (ENTRY.replace("- ", "-"), "a space is missing after the dash in line 1"),
        (ENTRY.replace("ros_type_name", "ros_msg_type"), "the key 'ros_msg_type' is not known; did you mean"),
    ],
)
def test_a_file_of_another_kind_is_told_from_a_list(text, words):
    assert words in str(fault("bridge.yaml", text.encode()))
