"""Conversion of stamps, headers and frame names, for every stamped message in `convert/`.

Gazebo keeps ROS's `frame_id` as a key with a value in `header.data`; odometry and transforms also use the key
`child_frame_id`. Gazebo scopes names with `::` where ROS writes `/`.

A new ROS message (`blank`) comes with all its parts. They are filled in place (`fill_...`), because creating Python
objects costs more than copying the numbers in them.

Source: ros_gz_bridge/src/convert/std_msgs.cpp and utils.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

from typing import Any

from builtin_interfaces.msg import Duration as RosDuration
from builtin_interfaces.msg import Time as RosTime
from std_msgs.msg import Header as RosHeader

from gz_course.sim.bridge.ros_gz_bridge.remarks import remark

FRAME_ID = "frame_id"
CHILD_FRAME_ID = "child_frame_id"
_INT32 = range(-(2**31), 2**31)


def fill_stamp(gz_time: Any, ros_time: RosTime | RosDuration) -> None:
    """Write a `gz.msgs.Time` or `Duration` (sec int64, nsec int32) into a ROS one (sec int32, nanosec uint32).

    What does not fit is reduced to 32 bits, as in C++.
    """
    sec, nsec = gz_time.sec, gz_time.nsec
    if sec not in _INT32 or nsec < 0:
        ros_time.sec, ros_time.nanosec = _int32(sec), nsec % 2**32
        remark(f"the stamp {sec} s {nsec} ns does not fit a ROS time; it became {ros_time.sec} s {ros_time.nanosec} ns")
        return
    ros_time.sec, ros_time.nanosec = sec, nsec


def copy_stamp(ros_time: RosTime | RosDuration, gz_time: Any) -> None:
    """Write a ROS time or duration into a `gz.msgs.Time` or `Duration`; too many nanoseconds become negative."""
    sec, nanosec = ros_time.sec, ros_time.nanosec
    gz_time.sec, gz_time.nsec = sec, _int32(nanosec)
    if gz_time.nsec < 0:
        remark(f"the stamp {sec} s {nanosec} ns does not fit a Gazebo time; it became {sec} s {gz_time.nsec} ns")


def _int32(number: int) -> int:
    return (number + 2**31) % 2**32 - 2**31


def frame_to_ros(name: str) -> str:
    """Return the ROS frame (`robot/base/lidar`) of a Gazebo scoped name (`robot::base::lidar`)."""
    return name.replace("::", "/")


def header_value(gz_header: Any, key: str, first: bool = False) -> str:
    """Return the frame stored under `key`, in the spelling of ROS: the last one of several, or the `first`.

    A key without value does not count. The text is empty if there is none.
    """
    for entry in gz_header.data if first else reversed(gz_header.data):
        if entry.key == key and entry.value:
            return frame_to_ros(entry.value[0])
    return ""


def set_header_value(gz_header: Any, key: str, value: str) -> None:
    """Append `key` with one value to a Gazebo header."""
    entry = gz_header.data.add()
    entry.key = key
    entry.value.append(value)


def fill_header(gz_header: Any, ros_header: RosHeader) -> None:
    fill_stamp(gz_header.stamp, ros_header.stamp)
    ros_header.frame_id = header_value(gz_header, FRAME_ID)


def copy_header(ros_header: RosHeader, gz_header: Any) -> None:
    copy_stamp(ros_header.stamp, gz_header.stamp)
    set_header_value(gz_header, FRAME_ID, ros_header.frame_id)
