"""A bridge that publishes a clock in Gazebo: Gazebo then stops publishing its own clock on that topic."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System
from gz_course.sim.bridge.ros_gz_bridge.entry import Direction


def look(system: System) -> Iterator[Finding]:
    """Find clock entries that do not go from Gazebo to ROS only."""
    for bridge, entry in system.entries():
        if entry.ros_type == "rosgraph_msgs/msg/Clock" and entry.direction is not Direction.GZ_TO_ROS:
            yield Finding(
                Severity.ERROR,
                f"The bridge {bridge.node} publishes the clock {entry.gz_topic} in Gazebo, too: a Gazebo started after "
                "it then keeps its own clock off that topic.",
                "Write direction: GZ_TO_ROS for the clock (on the command line the mark [); without it a bridge is "
                "BIDIRECTIONAL.",
                (f"direction: {entry.direction.value}",),
                frozenset({entry.ros_topic}),
            )
