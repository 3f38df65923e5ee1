"""rosgraph_msgs: Clock, the simulated time every node with ``use_sim_time`` lives by."""

from __future__ import annotations

from typing import Any

from rosgraph_msgs.msg import Clock

from gz_course.sim.gz.msgs.clock_pb2 import Clock as GzClock
from gz_course.sim.ros_gz_bridge.blank import blank
from gz_course.sim.ros_gz_bridge.header import fill_stamp, stamp_to_gz
from gz_course.sim.ros_gz_bridge.type_pairs import type_pair


@type_pair("rosgraph_msgs/msg/Clock", "gz.msgs.Clock")
class ClockPair:
    """Only Gazebo's ``sim`` time travels; ``real`` and ``system`` have no place in the ROS message."""

    @staticmethod
    def to_ros(gz: Any) -> Clock:
        """Gazebo to ROS."""
        ros = blank(Clock)
        fill_stamp(gz.sim, ros.clock)
        return ros

    @staticmethod
    def to_gz(ros: Clock) -> Any:
        """ROS to Gazebo."""
        gz = GzClock()
        stamp_to_gz(ros.clock, gz.sim)
        return gz
