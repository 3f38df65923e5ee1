"""builtin_interfaces: Time.

Source: ros_gz_bridge/src/convert/builtin_interfaces.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

from builtin_interfaces.msg import Time

from gz_course.sim.bridge.ros_gz_bridge.fields import Part, message_pair
from gz_course.sim.bridge.ros_gz_bridge.header import copy_stamp, fill_stamp

message_pair("builtin_interfaces/msg/Time", "gz.msgs.Time", Part(Time, fill_stamp, copy_stamp))
