"""Nodes that wait for simulated time while there is no clock: their time stays 0 and their timers never fire."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.advice import bridge_command
from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System, names
from gz_course.sim.bridge.ros_gz_bridge.entry import Direction


def look(system: System) -> Iterator[Finding]:
    """Find nodes with use_sim_time if there is no `/clock`, or a silent one."""
    waiting = [node.name for node in system.ros.nodes if node.use_sim_time and not system.is_bridge(node.name)]
    if not waiting or system.ros.clock:
        return
    publishers = system.ros_ends("/clock", publish=True)
    if any(end.type != "rosgraph_msgs/msg/Clock" for end in publishers):
        return
    have = "has" if len(set(waiting)) == 1 else "have"
    if publishers:
        yield Finding(
            Severity.ERROR,
            f"{names(waiting)} {have} use_sim_time, but /clock is silent though {names(e.node for e in publishers)} "
            "publishes it: timers do not fire.",
            "See whether the simulator runs in this Gazebo partition, and that the bridge's clock is GZ_TO_ROS.",
            (f"nothing came on /clock in {system.ros.seconds:g} s",),
        )
        return
    clocks = [topic for topic in system.gz_topics(publish=True) if topic.rpartition("/")[2] == "clock"]
    gz_clock = min(clocks, key=len, default="/clock")
    command = bridge_command("/clock", gz_clock, "rosgraph_msgs/msg/Clock", "gz.msgs.Clock", Direction.GZ_TO_ROS)
    yield Finding(
        Severity.ERROR,
        f"{names(waiting)} {have} use_sim_time, but nobody publishes /clock: the time stays 0 and timers never fire.",
        f"Bridge Gazebo's clock: {command}" + ("" if clocks else "; no simulator that has one runs here yet"),
        (f"Gazebo publishes {names(clocks)}",) if clocks else (),
    )
