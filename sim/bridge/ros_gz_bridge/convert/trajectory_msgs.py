"""trajectory_msgs: JointTrajectory, a plan for several joints: [rad] or [m] and their derivatives, [N] or [N m].

Source: trajectory_msgs/msg/JointTrajectoryPoint.msg, https://github.com/ros2/common_interfaces
"""

from __future__ import annotations

import math

from builtin_interfaces.msg import Duration
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from gz_course.sim.bridge.ros_gz_bridge.fields import DOUBLES, HEADER, TEXTS, Each, Fields, Part, message_pair
from gz_course.sim.bridge.ros_gz_bridge.header import copy_stamp, fill_stamp

_NUMBERS = ("positions", "velocities", "accelerations", "effort")


def _fault(ros: JointTrajectory) -> str | None:
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
    time_from_start=Part(Duration, fill_stamp, copy_stamp),
)

message_pair(
    "trajectory_msgs/msg/JointTrajectory",
    "gz.msgs.JointTrajectory",
    Fields(JointTrajectory, header=HEADER, joint_names=TEXTS, points=Each(_POINT)),
    fault=_fault,
)
