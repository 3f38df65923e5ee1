"""Images in the frame of the camera's body: ROS takes z as forward, Gazebo x."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System

_CAMERAS = {"camera", "depth_camera", "rgbd_camera", "segmentation_camera", "thermal_camera", "wideanglecamera"}


def look(system: System) -> Iterator[Finding]:
    """Find bridged images and camera infos of a world whose cameras name no optical frame."""
    bare = [
        sensor.name
        for world in system.gz.worlds
        if world.text is not None
        for sensor in world.text.sensors
        if sensor.type in _CAMERAS and not sensor.text("camera/optical_frame_id")
    ]
    if not bare:
        return
    for _, entry in system.entries():
        if entry.direction.to_ros and entry.ros_type in ("sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo"):
            yield Finding(
                Severity.NOTE,
                f"The camera {bare[0]} has no optical frame, but {entry.ros_topic} carries its images to ROS, which "
                "takes z as forward.",
                "Give the <camera> an <optical_frame_id> whose frame is turned by -90, 0, -90 degrees "
                "(roll -pi/2, yaw -pi/2) against the camera's link.",
            )
            return
