"""Advice shared by several looks: how to bridge a topic, and which topics can be bridged."""

from __future__ import annotations

from gz_course.sim.bridge.ros_gz_bridge.arguments import MARK_OF
from gz_course.sim.bridge.ros_gz_bridge.entry import Direction
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import UnknownPairError, find_pair


def can_bridge(ros_type: str, gz_type: str) -> bool:
    """Return whether ros_gz_bridge converts between the two types."""
    try:
        find_pair(ros_type, gz_type)
    except UnknownPairError:
        return False
    return True


def bridge_command(ros_topic: str, gz_topic: str, ros_type: str, gz_type: str, direction: Direction) -> str:
    """Return the command line that bridges one topic."""
    remap = f" --ros-args -r {gz_topic}:={ros_topic}" if ros_topic != gz_topic else ""
    return f"ros2 run ros_gz_bridge parameter_bridge '{gz_topic}@{ros_type}{MARK_OF[direction]}{gz_type}'{remap}"
