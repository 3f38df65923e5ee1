"""Data in a frame that /tf does not know, often Gazebo's default name robot/link/sensor."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System, names

BEFORE = ("silent_topic",)


def look(system: System) -> Iterator[Finding]:
    """Find frames that are not in the tree of transforms; without a tree, the default names of Gazebo's sensors."""
    known = system.ros.frames
    scoped = {sensor.name for world in system.gz.worlds if world.text for sensor in world.text.sensors}
    for topic, heard in sorted(system.ros.heard.items()):
        frames = {
            frame.strip("/")
            for each in heard.messages
            if (frame := getattr(getattr(each.message, "header", None), "frame_id", ""))
        }
        default = {frame for frame in frames if frame in scoped or frame.count("/") >= 2}
        lost = frames - known if known else default
        if not lost:
            continue
        advice = "Give the sensor a <gz_frame_id> that is a link of your robot's description, or the bridge a frame_id."
        yield Finding(
            Severity.WARNING if known else Severity.NOTE,
            f"Messages on {topic} are in the frame {names(lost)}, "
            + ("which /tf does not know." if known else "Gazebo's default name, which no robot description has."),
            advice
            if default
            else f"Publish the transform from a known frame to {sorted(lost)[0]}, or correct the frame.",
            (f"/tf knows {names(sorted(known)[:12])}",) if known else (),
        )
