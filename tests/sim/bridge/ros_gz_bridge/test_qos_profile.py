"""The named QoS profiles are those of ROS."""

import pytest
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

from gz_course.sim.bridge.ros_gz_bridge.qos_profile import depth_of, qos


@pytest.mark.parametrize(
    ("profile", "reliability", "durability", "depth"),
    [
        ("CLOCK", ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.VOLATILE, 1),
        ("SENSOR_DATA", ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.VOLATILE, 5),
        ("ROSOUT", ReliabilityPolicy.RELIABLE, DurabilityPolicy.TRANSIENT_LOCAL, 1000),
        ("SYSTEM_DEFAULT", ReliabilityPolicy.SYSTEM_DEFAULT, DurabilityPolicy.SYSTEM_DEFAULT, 1),
        (None, ReliabilityPolicy.RELIABLE, DurabilityPolicy.VOLATILE, 10),
    ],
)
def test_the_profiles_are_those_of_ros(profile, reliability, durability, depth):
    chosen = qos(profile, depth_of(profile))
    assert (chosen.reliability, chosen.durability, chosen.depth) == (reliability, durability, depth)
