"""A node or a bridge that subscribes to a topic without publishers; often the intended name is similar."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import INFRASTRUCTURE, OTHER_TYPE, System, nearest_topic, users
from gz_course.sim.gz.msgs import canonical_name

BEFORE = ("nobody_listens", "optical_frame")


def look(system: System) -> Iterator[Finding]:
    """Find bridges without a source in Gazebo, then nodes, then bridges without a source in ROS."""
    yield from _from_gazebo(system)
    for topic in sorted({end.topic for end in system.ros.endpoints if not end.publishes} - INFRASTRUCTURE):
        waiting = system.ros_users(topic, publish=False)
        if not waiting or system.ros_ends(topic, publish=True):
            continue
        near = _sent_in_ros(system, topic, waiting[0].type)
        yield Finding(
            Severity.ERROR,
            f"{users(waiting, 'listen')} on {topic} ({waiting[0].type}), but nobody publishes it.",
            _did_you_mean(near) or "Start the node or the bridge that publishes it, or correct the name.",
            (_who_sends(system, near),) if near else (),
            frozenset({topic}),
            symptom=True,
        )
    yield from _from_ros(system)


def _from_gazebo(system: System) -> Iterator[Finding]:
    sent = system.gz_topics(publish=True)
    for bridge, entry in system.entries():
        ways = [way for way in (True, False) if system.gz_users(entry.gz_topic, publish=way)]
        if not entry.direction.to_ros or entry.direction.to_gz or ways:
            continue
        same = [topic for topic, types in sent.items() if _holds(types, entry.gz_type)]
        near = nearest_topic(entry.gz_topic, same) or nearest_topic(entry.gz_topic, sent, OTHER_TYPE)
        yield Finding(
            Severity.ERROR,
            f"The bridge {bridge.node} waits for {entry.gz_topic} from Gazebo, but nobody publishes it there.",
            _did_you_mean(near, "gz_topic_name") or "See gz topic -l for what Gazebo publishes.",
            (f"bridged to {entry.ros_topic} ({entry.ros_type})",),
            frozenset({entry.ros_topic}),
            symptom=True,
        )


def _from_ros(system: System) -> Iterator[Finding]:
    for bridge, entry in system.entries():
        if not entry.direction.to_gz or entry.direction.to_ros or system.ros_ends(entry.ros_topic, publish=True):
            continue
        if not system.gz_users(entry.gz_topic, publish=False):
            continue
        unheard = [
            end.topic
            for end in system.ros.endpoints
            if end.publishes and end.type == entry.ros_type and not system.ros_ends(end.topic, publish=False)
        ]
        near = nearest_topic(entry.ros_topic, unheard) or (unheard[0] if unheard else "")
        yield Finding(
            Severity.ERROR if near else Severity.NOTE,
            f"The bridge {bridge.node} waits for {entry.ros_topic} ({entry.ros_type}), but nobody in ROS publishes it.",
            _did_you_mean(near) or "Start the node that publishes it; until then Gazebo receives nothing.",
            (_who_sends(system, near),) if near else (f"bridged to {entry.gz_topic} in Gazebo",),
            frozenset({entry.ros_topic}),
        )


def _holds(types: set[str], wanted: str) -> bool:
    return not wanted or canonical_name(wanted) in {canonical_name(each) for each in types}


def _sent_in_ros(system: System, topic: str, kind: str) -> str:
    sent = {end.topic: end.type for end in system.ros.endpoints if end.publishes and end.topic not in INFRASTRUCTURE}
    return nearest_topic(topic, [each for each in sent if sent[each] == kind]) or nearest_topic(topic, sent, OTHER_TYPE)


def _did_you_mean(near: str, key: str = "") -> str:
    return (
        f"Did you mean {near}?" + (f" Correct the bridge's {key}." if key else " Correct the name or remap it.")
        if (near)
        else ""
    )


def _who_sends(system: System, topic: str) -> str:
    ends = system.ros_ends(topic, publish=True)
    return f"{users(ends, 'publish')} {topic} ({ends[0].type})"
