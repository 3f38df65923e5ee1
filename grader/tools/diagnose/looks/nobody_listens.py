"""A node or a bridge that publishes on a topic without subscribers."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import INFRASTRUCTURE, System, nearest_topic, users
from gz_course.sim.gz.msgs import canonical_name

_ANY = "google.protobuf.Message"


def look(system: System) -> Iterator[Finding]:
    """Find bridges to Gazebo topics without subscribers, then ROS publishers without subscribers."""
    yield from _in_gazebo(system)
    for topic in sorted({end.topic for end in system.ros.endpoints if end.publishes} - INFRASTRUCTURE):
        senders = system.ros_users(topic, publish=True)
        if not senders or system.ros_ends(topic, publish=False):
            continue
        kind = senders[0].type
        waiting = {
            end.topic
            for end in system.ros.endpoints
            if not end.publishes and end.type == kind and not system.ros_ends(end.topic, publish=True)
        }
        near = nearest_topic(topic, waiting)
        yield Finding(
            Severity.ERROR if near else Severity.NOTE,
            f"{users(senders, 'publish')} {topic} ({kind}), but nobody listens.",
            f"Did you mean {near}? Correct the name or remap it."
            if near
            else "Start the node or the bridge that listens, or correct the name.",
            (f"{users(system.ros_ends(near, publish=False), 'listen')} on {near}",) if near else (),
            frozenset({topic}),
            symptom=True,
        )


def _in_gazebo(system: System) -> Iterator[Finding]:
    heard = system.gz_topics(publish=False)
    for bridge, entry in system.entries():
        ways = [way for way in (True, False) if system.gz_users(entry.gz_topic, publish=way)]
        if not entry.direction.to_gz or entry.direction.to_ros or ways:
            continue
        wanted = canonical_name(entry.gz_type) if entry.gz_type else _ANY
        same = [topic for topic, types in heard.items() if wanted in {canonical_name(each) for each in types - {_ANY}}]
        near = nearest_topic(entry.gz_topic, same) or (same[0] if len(same) == 1 else "")
        yield Finding(
            Severity.ERROR,
            f"The bridge {bridge.node} publishes {entry.gz_topic} in Gazebo, but nobody there listens.",
            f"Did you mean {near}? Correct the bridge's gz_topic_name."
            if near
            else "See gz topic -l and gz topic -i -t TOPIC for what Gazebo listens to.",
            (f"bridged from {entry.ros_topic} ({entry.ros_type})",),
            frozenset({entry.ros_topic}),
            symptom=True,
        )
