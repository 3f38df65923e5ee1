"""builtin_interfaces: Time."""

from __future__ import annotations

from typing import Any

from builtin_interfaces.msg import Time

from gz_course.sim.gz.msgs.time_pb2 import Time as GzTime
from gz_course.sim.ros_gz_bridge.header import stamp_to_gz, stamp_to_ros
from gz_course.sim.ros_gz_bridge.type_pairs import type_pair


@type_pair("builtin_interfaces/msg/Time", "gz.msgs.Time")
class TimePair:
    """Seconds and nanoseconds, copied."""

    @staticmethod
    def to_ros(gz: Any) -> Time:
        """Gazebo to ROS."""
        return stamp_to_ros(gz)

    @staticmethod
    def to_gz(ros: Time) -> Any:
        """ROS to Gazebo."""
        gz = GzTime()
        stamp_to_gz(ros, gz)
        return gz
