"""A topic of the bridge that is advertised, but has no messages."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System

BEFORE = ("clock_goes_back", "same_node_name")


def look(system: System) -> Iterator[Finding]:
    """Find entries to ROS without a message although the world runs and Gazebo publishes the topic."""
    if any(world.statistics and world.statistics[-1].paused for world in system.gz.worlds):
        return
    for bridge, entry in system.entries():
        heard = system.ros.heard.get(entry.ros_topic)
        if not entry.direction.to_ros or heard is None or heard.count or entry.lazy:
            continue
        if not system.gz_users(entry.gz_topic, publish=True) or entry.ros_topic == "/clock":
            continue
        yield Finding(
            Severity.WARNING,
            f"Gazebo publishes {entry.gz_topic} and {bridge.node} bridges it, but nothing came on {entry.ros_topic} "
            f"in {system.ros.seconds:g} s.",
            f"See whether Gazebo sends: gz topic -e -t {entry.gz_topic}. A slow update_rate needs a longer --seconds, "
            "a triggered camera waits for its trigger.",
            (f"{entry.gz_topic} ({entry.gz_type}) -> {entry.ros_topic} ({entry.ros_type})",),
            frozenset({entry.ros_topic}),
            symptom=True,
        )
