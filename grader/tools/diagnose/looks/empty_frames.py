"""Messages without a frame: their data cannot be located."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System, names

_NEED_NONE = {"sensor_msgs/msg/JointState", "sensor_msgs/msg/Joy", "sensor_msgs/msg/BatteryState"}
_POSE_INFO = ("/pose/info", "/dynamic_pose/info")


def look(system: System) -> Iterator[Finding]:
    """Find topics of which a message has an empty frame_id (or child_frame_id)."""
    for topic, heard in sorted(system.ros.heard.items()):
        if heard.type in _NEED_NONE:
            continue
        empty = {name for each in heard.messages for name in _empty(each.message)}
        if not empty:
            continue
        brings = (entry for _, entry in system.entries() if entry.ros_topic == topic and entry.direction.to_ros)
        source = next((entry.gz_topic for entry in brings), "")
        from_scene = source.startswith("/world/") and source.endswith(_POSE_INFO)
        yield Finding(
            Severity.WARNING,
            f"Messages on {topic} ({heard.type}) have an empty {names(empty)}.",
            "Gazebo's pose/info has no frames: bridge the topic of a PosePublisher or OdometryPublisher instead."
            if from_scene
            else "Set header.frame_id; for messages of the bridge override_frame_id, or <gz_frame_id> of the sensor.",
            (f"bridged from {source}",) if source else (),
        )


def _empty(message: object) -> Iterator[str]:
    poses = getattr(message, "transforms", None)
    for each in [message] if poses is None else poses:
        header = getattr(each, "header", None)
        if header is not None and not header.frame_id:
            yield "header.frame_id"
        if getattr(each, "child_frame_id", None) == "":
            yield "child_frame_id"
