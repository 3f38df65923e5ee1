"""Stamps, headers and frame names: the rules every stamped message shares.

Gazebo keeps ROS's ``frame_id`` as a key with a value in ``header.data``; odometry and transforms also use the
key ``child_frame_id``. Gazebo scopes names with ``::`` where ROS writes ``/``. The files in ``convert/`` call
these functions, so the rules are written once.

A new ROS message (``blank``) comes with all its parts, and a Python object costs more than the numbers in it. So they
are filled in place (``fill_...``) instead of being replaced by parts that were made a second time.
"""

from __future__ import annotations

from typing import Any

from builtin_interfaces.msg import Duration as RosDuration
from builtin_interfaces.msg import Time as RosTime
from std_msgs.msg import Header as RosHeader

from gz_course.sim.ros_gz_bridge.blank import blank
from gz_course.sim.ros_gz_bridge.type_pairs import ConversionError

FRAME_ID = "frame_id"
CHILD_FRAME_ID = "child_frame_id"
_INT32 = range(-(2**31), 2**31)


def fill_stamp(gz_time: Any, ros_time: RosTime | RosDuration) -> None:
    """Write a ``gz.msgs.Time`` (sec int64, nsec int32) into a ROS time (sec int32, nanosec uint32)."""
    sec, nsec = gz_time.sec, gz_time.nsec
    if sec not in _INT32 or nsec < 0:
        raise ConversionError(f"the stamp {sec} s {nsec} ns does not fit a ROS time")
    ros_time.sec, ros_time.nanosec = sec, nsec


def stamp_to_ros(gz_time: Any) -> RosTime:
    """A ``gz.msgs.Time`` as a ROS time."""
    ros = RosTime()
    fill_stamp(gz_time, ros)
    return ros


def stamp_to_gz(ros_time: RosTime, gz_time: Any) -> None:
    """Write a ROS time into ``gz_time`` (a ``gz.msgs.Time``)."""
    if ros_time.nanosec >= 2**31:
        raise ConversionError(f"the stamp {ros_time.sec} s {ros_time.nanosec} ns does not fit a Gazebo time")
    gz_time.sec = ros_time.sec
    gz_time.nsec = ros_time.nanosec


def duration_to_ros(gz_duration: Any) -> RosDuration:
    """A ``gz.msgs.Duration`` (sec int64, nsec int32) as a ROS duration (sec int32, nanosec uint32)."""
    ros = RosDuration()
    fill_stamp(gz_duration, ros)
    return ros


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


def fill_header(gz_header: Any, ros_header: RosHeader) -> None:
    """Write stamp and ``frame_id`` of a ``gz.msgs.Header`` into a ROS header."""
    fill_stamp(gz_header.stamp, ros_header.stamp)
    ros_header.frame_id = header_value(gz_header, FRAME_ID)


def header_to_ros(gz_header: Any) -> RosHeader:
    """Stamp and ``frame_id`` of a ``gz.msgs.Header``."""
    ros = blank(RosHeader)
    fill_header(gz_header, ros)
    return ros


def header_to_gz(ros_header: RosHeader, gz_header: Any) -> None:
    """Write stamp and ``frame_id`` into ``gz_header`` (a ``gz.msgs.Header``)."""
    stamp_to_gz(ros_header.stamp, gz_header.stamp)
    set_header_value(gz_header, FRAME_ID, ros_header.frame_id)
