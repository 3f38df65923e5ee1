"""actuator_msgs: Actuators, commands to motors (rad or m, rad/s or m/s, or -1 to 1)."""

from __future__ import annotations

import math

from actuator_msgs.msg import Actuators

from gz_course.sim.ros_gz_bridge.fields import DOUBLES, HEADER, Fields, add_fields

_NUMBERS = ("position", "velocity", "normalized")


def _fault(ros: Actuators) -> str | None:
    """The numbers no motor can follow (``"velocity[1] is nan"``), or None."""
    bad = [
        f"{field}[{index}] is {number}"
        for field in _NUMBERS
        for index, number in enumerate(getattr(ros, field))
        if not math.isfinite(number)
    ]
    return ", ".join(bad) or None


add_fields(
    "actuator_msgs/msg/Actuators",
    "gz.msgs.Actuators",
    Fields(Actuators, header=HEADER, **dict.fromkeys(_NUMBERS, DOUBLES)),
    fault=_fault,
)
