"""The two graphs in a recording: the bridges between them, and the direction of messages.

The checks on tables and bridges (`checks/table_*.py`, `checks/bridge*.py`) read them from the facts that
`run/graph_snapshot.py` recorded.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gz_course.grader.record.reading import Recording

WAYS = ("GZ_TO_ROS", "ROS_TO_GZ", "BIDIRECTIONAL")


@dataclass(frozen=True)
class Qos:
    """The quality of service an endpoint offers or requests."""

    reliability: str
    durability: str
    depth: int


@dataclass(frozen=True)
class Bridged:
    """One bridge of a run: its configuration (`source` is `file:line`), and the messages it passed each way."""

    source: str
    ros_topic: str
    ros_type: str
    gz_topic: str
    gz_type: str
    direction: str
    to_ros: int
    to_gz: int
    publisher_qos: Qos | None
    subscription_qos: Qos | None

    @property
    def place(self) -> str:
        """Where it is configured, in words."""
        file, _, line = self.source.rpartition(":")
        return f"{file}, line {line}" if file else self.source


def bridges(recording: Recording) -> list[Bridged]:
    """Return the bridges of a run, in the order of the file."""

    def qos(raw: dict[str, Any] | None) -> Qos | None:
        return Qos(**raw) if raw is not None else None

    return [
        Bridged(**raw | {"publisher_qos": qos(raw["publisher_qos"]), "subscription_qos": qos(raw["subscription_qos"])})
        for raw in recording.facts().get("bridges", [])
    ]


@dataclass(frozen=True)
class Link:
    """One bridged topic as it was on both sides: the correct row of a student's table."""

    ros_topic: str
    ros_type: str
    gz_topic: str
    gz_type: str
    direction: str  # direction of the messages; empty if there were none
    publisher: tuple[str, ...]  # ROS nodes that published on it


def links(recording: Recording) -> list[Link]:
    """Return the bridged topics, sorted by ROS name. Types and publishers are those of the live graphs."""
    facts = recording.facts()
    ros, gz = facts.get("ros_topics", {}), facts.get("gz_topics", {})
    found = []
    for bridge in sorted(bridges(recording), key=lambda bridge: bridge.ros_topic):
        ros_types = ros.get(bridge.ros_topic, {}).get("types", [])
        gz_types = gz.get(bridge.gz_topic, {}).get("types", [])
        publishers = ros.get(bridge.ros_topic, {}).get("publishers", [])
        found.append(
            Link(
                bridge.ros_topic,
                ros_types[0] if ros_types else bridge.ros_type,
                bridge.gz_topic,
                gz_types[0] if gz_types else bridge.gz_type,
                {(True, False): "GZ_TO_ROS", (False, True): "ROS_TO_GZ", (True, True): "BIDIRECTIONAL"}.get(
                    (bridge.to_ros > 0, bridge.to_gz > 0), ""
                ),
                tuple(publishers),
            )
        )
    return found
