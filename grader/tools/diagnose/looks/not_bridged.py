"""A topic with one name in ROS and Gazebo that no bridge carries: it was not started, has ended, or lacks an entry."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.advice import bridge_command, can_bridge
from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import INFRASTRUCTURE, RosEndpoint, System, users
from gz_course.sim.bridge.ros_gz_bridge.entry import Direction

BEFORE = ("no_answer",)


def look(system: System) -> Iterator[Finding]:
    """Find ROS endpoints without a partner in ROS whose partner is in Gazebo."""
    for topic in sorted({end.topic for end in system.ros.endpoints} - INFRASTRUCTURE):
        for publish in (True, False):
            mine, others = system.ros_ends(topic, publish=publish), system.ros_ends(topic, publish=not publish)
            if mine and not others and not system.is_bridge(mine[0].node):
                yield from _beyond(system, topic, mine, publish)


def _beyond(system: System, topic: str, mine: list[RosEndpoint], publish: bool) -> Iterator[Finding]:
    bridged = {entry.gz_topic for _, entry in system.entries()}
    beyond = system.gz_topics(publish=not publish)
    tail = topic.rpartition("/")[2]
    alike = [name for name in beyond if name not in bridged and name.rpartition("/")[2] == tail]
    for gz_topic in sorted(alike, key=lambda name: (name != topic, len(name), name)):
        gz_type = next((each for each in sorted(beyond[gz_topic]) if can_bridge(mine[0].type, each)), None)
        if gz_type is None:
            continue
        direction = Direction.ROS_TO_GZ if publish else Direction.GZ_TO_ROS
        does, on, gazebo = ("publish", "", "listens on") if publish else ("listen", " on", "publishes")
        where = "it" if gz_topic == topic else gz_topic
        missing = "no bridge carries it" if system.ros.bridges else "no ros_gz_bridge runs"
        yield Finding(
            Severity.ERROR,
            f"{users(mine, does)}{on} {topic} in ROS and Gazebo {gazebo} {where}, but {missing}.",
            f"Start it: {bridge_command(topic, gz_topic, mine[0].type, gz_type, direction)}",
            (f"ROS: {topic} ({mine[0].type})", f"Gazebo: {gz_topic} ({gz_type})"),
            frozenset({topic}),
        )
        return
