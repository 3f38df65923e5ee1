"""trajectory_msgs: JointTrajectory, a plan for several joints (rad or m, and their derivatives; N or Nm)."""

from __future__ import annotations

import math

from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from gz_course.sim.ros_gz_bridge.fields import DOUBLES, HEADER, TEXTS, Each, Fields, Part, add_fields
from gz_course.sim.ros_gz_bridge.header import duration_to_ros, stamp_to_gz

_NUMBERS = ("positions", "velocities", "accelerations", "effort")


def _fault(ros: JointTrajectory) -> str | None:
    """The numbers no joint can follow (``"points[2].positions[0] is nan"``), or None."""
    bad = [
        f"points[{index}].{field}[{joint}] is {number}"
        for index, point in enumerate(ros.points)
        for field in _NUMBERS
        for joint, number in enumerate(getattr(point, field))
        if not math.isfinite(number)
    ]
    return ", ".join(bad) or None


_POINT = Fields(
    JointTrajectoryPoint,
    **dict.fromkeys(_NUMBERS, DOUBLES),
    time_from_start=Part(duration_to_ros, stamp_to_gz),
)

add_fields(
    "trajectory_msgs/msg/JointTrajectory",
    "gz.msgs.JointTrajectory",
    Fields(JointTrajectory, header=HEADER, joint_names=TEXTS, points=Each(_POINT)),
    fault=_fault,
)
