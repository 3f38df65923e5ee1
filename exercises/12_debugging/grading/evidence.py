"""What the recording holds of the system: its endpoints, who died, and suspicious places in its files."""

from __future__ import annotations

from typing import Any

from gz_course.grader.record.reading import Recording
from gz_course.grader.score.launched import deaths

SCAN, COMMANDS, LASER_SCAN, RANGE = "/scan", "/cmd_vel", "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Range"
FRAMES, MOUNT = ("base_link", "lidar_link"), (-0.2, 0.0, 0.19)  # parent and child; the child in the parent [m]


def ends_of(recording: Recording, kind: str, type: str | None = None, topic: str | None = None) -> list[Any]:
    found = recording.facts().get("endpoints", [])
    return [e for e in found if e["kind"] == kind and type in (None, e["type"]) and topic in (None, e["topic"])]


def died(recording: Recording, name: str) -> Any:
    said = " ".join(line.text for line in recording.lines("log/student"))
    return f"{name}_node.py" in said and bool(list(deaths(recording)))


def suspected_in(recording: Recording, file: str, *about: str) -> str:
    """Return the first place in a file that is suspected of one of these things, with its words; empty if none is."""
    for each in recording.facts().get("suspects", []):
        if each.get("file") == file and each["about"] in about:
            return f"{file}, line {each['line']}: {each['said']}"
    return ""
