"""Stamps, headers and frame names: the rules every stamped message shares.

Gazebo keeps ROS's ``frame_id`` as a key with a value in ``header.data``; odometry and transforms also use the
key ``child_frame_id``. Gazebo scopes names with ``::`` where ROS writes ``/``. The files in ``convert/`` call
these functions, so the rules are written once.
"""

from __future__ import annotations

from typing import Any

from builtin_interfaces.msg import Duration as RosDuration
from builtin_interfaces.msg import Time as RosTime
from std_msgs.msg import Header as RosHeader

from ros_gz_bridge.type_pairs import ConversionError

FRAME_ID = "frame_id"
CHILD_FRAME_ID = "child_frame_id"
_INT32 = range(-(2**31), 2**31)


def stamp_to_ros(gz_time: Any) -> RosTime:
    """A ``gz.msgs.Time`` (sec int64, nsec int32) as a ROS time (sec int32, nanosec uint32)."""
    if gz_time.sec not in _INT32 or gz_time.nsec < 0:
        raise ConversionError(f"the stamp {gz_time.sec} s {gz_time.nsec} ns does not fit a ROS time")
    return RosTime(sec=gz_time.sec, nanosec=gz_time.nsec)


def stamp_to_gz(ros_time: RosTime, gz_time: Any) -> None:
    """Write a ROS time into ``gz_time`` (a ``gz.msgs.Time``)."""
    if ros_time.nanosec >= 2**31:
        raise ConversionError(f"the stamp {ros_time.sec} s {ros_time.nanosec} ns does not fit a Gazebo time")
    gz_time.sec = ros_time.sec
    gz_time.nsec = ros_time.nanosec


def duration_to_ros(gz_duration: Any) -> RosDuration:
    """A ``gz.msgs.Duration`` (sec int64, nsec int32) as a ROS duration (sec int32, nanosec uint32)."""
    time = stamp_to_ros(gz_duration)
    return RosDuration(sec=time.sec, nanosec=time.nanosec)


def frame_to_ros(name: str) -> str:
    """A Gazebo scoped name (``robot::base::lidar``) as a ROS frame (``robot/base/lidar``)."""
    return name.replace("::", "/")


def header_value(gz_header: Any, key: str) -> str:
    """The frame kept under ``key``, in ROS spelling; the last entry counts, a missing one is empty."""
    for entry in reversed(gz_header.data):
        if entry.key == key:
            return frame_to_ros(entry.value[0]) if entry.value else ""
    return ""


def set_header_value(gz_header: Any, key: str, value: str) -> None:
    """Append ``key`` with one value to a Gazebo header."""
    entry = gz_header.data.add()
    entry.key = key
    entry.value.append(value)


def header_to_ros(gz_header: Any) -> RosHeader:
    """Stamp and ``frame_id`` of a ``gz.msgs.Header``."""
    return RosHeader(stamp=stamp_to_ros(gz_header.stamp), frame_id=header_value(gz_header, FRAME_ID))


def header_to_gz(ros_header: RosHeader, gz_header: Any) -> None:
    """Write stamp and ``frame_id`` into ``gz_header`` (a ``gz.msgs.Header``)."""
    stamp_to_gz(ros_header.stamp, gz_header.stamp)
    set_header_value(gz_header, FRAME_ID, ros_header.frame_id)
