"""A bridge whose direction is opposite to that of the messages."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System
from gz_course.sim.bridge.ros_gz_bridge.entry import Direction

BEFORE = ("qos", "stamps")


def look(system: System) -> Iterator[Finding]:
    """Find entries of one direction where Gazebo's end of the topic needs the other one."""
    for bridge, entry in system.entries():
        sends = system.gz_users(entry.gz_topic, publish=True)
        hears = system.gz_users(entry.gz_topic, publish=False)
        if entry.direction is Direction.GZ_TO_ROS and hears and not sends:
            does, right, mark = "listens", Direction.ROS_TO_GZ, "]"
        elif entry.direction is Direction.ROS_TO_GZ and sends and not hears:
            does, right, mark = "publishes", Direction.GZ_TO_ROS, "["
        else:
            continue
        yield Finding(
            Severity.ERROR,
            f"The bridge {bridge.node} carries {entry.gz_topic} {_words(entry.direction)}, but Gazebo {does} on it: "
            "the direction is wrong.",
            f"Write direction: {right.value} for this entry (on the command line the mark {mark}).",
            (
                f"{entry.gz_topic}: {len(sends)} publishers and {len(hears)} subscribers in Gazebo, "
                "those of bridges not counted",
                f"bridged to {entry.ros_topic} ({entry.ros_type})",
            ),
            frozenset({entry.ros_topic}),
        )


def _words(direction: Direction) -> str:
    return "from Gazebo to ROS" if direction is Direction.GZ_TO_ROS else "from ROS to Gazebo"
