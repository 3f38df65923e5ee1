"""Misconceptions about a table of topics: each is recognised, and none in a right table or in one slip."""

import pytest

from gz_course.grader.feedback.predictions.tables import explain_column, missing_rows
from gz_course.grader.score.graphs import Bridged, Link

LINKS = [
    Link("/scan", "sensor_msgs/msg/LaserScan", "/lidar", "gz.msgs.LaserScan", "GZ_TO_ROS", ("bridge",)),
    Link("/imu", "sensor_msgs/msg/Imu", "/imu", "gz.msgs.IMU", "GZ_TO_ROS", ("bridge",)),
    Link("/joints", "sensor_msgs/msg/JointState", "/joints", "gz.msgs.Model", "GZ_TO_ROS", ("bridge",)),
    Link("/cmd", "geometry_msgs/msg/Twist", "/model/r/cmd", "gz.msgs.Twist", "ROS_TO_GZ", ("patrol",)),
]
BRIDGES = [
    Bridged("bridge.yaml:1", each.ros_topic, each.ros_type, each.gz_topic, each.gz_type, way, 1, 1, None, None)
    for each, way in zip(LINKS, ("GZ_TO_ROS", "GZ_TO_ROS", "BIDIRECTIONAL", "ROS_TO_GZ"), strict=True)
]
ROS = {
    "/scan": {"subscribers": ["patrol"]},
    "/cmd": {"subscribers": ["bridge"]},
    "/joints": {"subscribers": ["bridge"]},
}


def explained(column, *said):
    """Explain a table that is right but for this column, whose values are `said`; None leaves one right."""
    pairs = []
    for line, (link, value) in enumerate(zip(LINKS, said, strict=True), 1):
        pairs.append(({"line": line, column: getattr(link, column) if value is None else value}, link))
    return explain_column(column, pairs, BRIDGES, {"/world/w/clock"})


@pytest.mark.parametrize(
    ("column", "said", "words"),
    [
        ("direction", ("ROS_TO_GZ", "ROS_TO_GZ", "ROS_TO_GZ", "GZ_TO_ROS"), "every row says the opposite direction"),
        ("direction", ("BIDIRECTIONAL",) * 4, "every row says BIDIRECTIONAL"),
        ("direction", ("GZ_TO_ROS",) * 4, "every row says GZ_TO_ROS"),
        ("direction", (None, None, "BIDIRECTIONAL", None), "the bridge of /joints is configured"),
        ("direction", (None, None, "ROS_TO_GZ", None), ""),
        ("publisher", ("lidar", "imu", "joint_state_publisher", "patrol"), "parts of Gazebo and no nodes of ROS"),
        ("publisher", ("gz_sim", "gz_sim", "gz_sim", "patrol"), ""),
        ("publisher", ("lidar", "imu", "patrol", "patrol"), ""),
        ("gz_type", (None, "gz.msgs.Imu", "gz.msgs.JointState", None), "line 2: gz.msgs.Imu is the name that the type"),
        ("gz_type", (None, "gz.msgs.Imu", "gz.msgs.Joints", None), ""),
        ("ros_type", (None, "sensor_msgs/msg/IMU", None, None), "ends in the name that the type has in Gazebo"),
        ("ros_type", (None, None, None, "std_msgs/msg/Twist"), ""),
        ("gz_topic", ("/model/r/lidar", "/model/r/imu", None, None), "line 1: /model/r/lidar has the model's name"),
        ("gz_topic", ("/world/w/lidar", None, None, None), "has the world's name in it"),
        ("gz_topic", ("/world/w/clock", None, None, None), ""),
        ("gz_topic", ("/laser", None, None, None), ""),
        ("publisher", ("patrol",) * 4, ""),
        ("gz_topic", ("/imu", "/lidar", None, None), "lines 1 and 2: /imu and /lidar are exchanged"),
        ("gz_type", ("gz.msgs.IMU", "gz.msgs.LaserScan", None, None), "are exchanged"),
        ("gz_topic", ("/imu", "/joints", "/lidar", None), ""),
        ("gz_topic", (None, None, None, "/model/robot/cmd"), "no model of this world has that name"),
        ("gz_topic", (None, None, None, "/model/robot/cmd_vel"), ""),
        (
            "direction",
            ("BIDIRECTIONAL", "BIDIRECTIONAL", None, "BIDIRECTIONAL"),
            "line 1: messages of /scan travel one",
        ),
        ("direction", ("BIDIRECTIONAL", "BIDIRECTIONAL", None, None), ""),
    ],
)
def test_a_column_with_one_misconception(column, said, words):
    found = explained(column, *said)
    assert words in found and bool(words) == bool(found)


@pytest.mark.parametrize("column", ["direction", "gz_type", "ros_type", "gz_topic"])
def test_a_right_column_and_an_empty_one_have_none(column):
    assert explained(column, *[None] * 4) == explained(column, *[""] * 4) == ""


@pytest.mark.parametrize(
    ("missing", "words"),
    [
        (["/imu", "/joints"], "no node in ROS listens to"),
        (["/cmd"], "what travels from ROS to Gazebo"),
        (["/scan", "/imu"], ""),
        ([], ""),
    ],
)
def test_rows_that_are_left_out(missing, words):
    found = missing_rows(missing, LINKS, ROS)
    assert words in found and bool(words) == bool(found)
