"""An IMU whose yaw starts at zero for every initial heading of the robot."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System

BEFORE = ("clock_rate",)


def look(system: System) -> Iterator[Finding]:
    """Find bridged IMUs of a world whose sensors name no reference frame."""
    if not any(entry.ros_type == "sensor_msgs/msg/Imu" for _, entry in system.entries()):
        return
    for world in system.gz.worlds:
        for sensor in world.text.sensors if world.text is not None else ():
            if sensor.type == "imu" and not sensor.text("imu/orientation_reference_frame/localization"):
                yield Finding(
                    Severity.NOTE,
                    f"The IMU {sensor.name} measures its orientation from its first pose: yaw is 0 wherever the robot "
                    "looks at the start.",
                    "For a compass heading add <orientation_reference_frame><localization>ENU</localization>"
                    "</orientation_reference_frame> to its <imu>.",
                )
