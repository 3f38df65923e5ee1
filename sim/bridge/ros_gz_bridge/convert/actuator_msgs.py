"""actuator_msgs: Actuators, commands to motors: [rad] or [m], [rad/s] or [m/s], or normalized from -1 to 1.

Source: actuator_msgs/msg/Actuators.msg, https://github.com/rudislabs/actuator_msgs
"""

from __future__ import annotations

import math

from actuator_msgs.msg import Actuators

from gz_course.sim.bridge.ros_gz_bridge.fields import DOUBLES, HEADER, Fields, message_pair

_NUMBERS = ("position", "velocity", "normalized")


def _fault(ros: Actuators) -> str | None:
    bad = [
        f"{field}[{index}] is {number}"
        for field in _NUMBERS
        for index, number in enumerate(getattr(ros, field))
        if not math.isfinite(number)
    ]
    return ", ".join(bad) or None


message_pair(
    "actuator_msgs/msg/Actuators",
    "gz.msgs.Actuators",
    Fields(Actuators, header=HEADER, **dict.fromkeys(_NUMBERS, DOUBLES)),
    fault=_fault,
)
