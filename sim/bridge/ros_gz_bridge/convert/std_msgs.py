"""std_msgs: the scalars, String, Empty, Header and ColorRGBA.

Source: ros_gz_bridge/src/convert/std_msgs.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

from std_msgs.msg import Bool, Empty, Float32, Float64, Int32, String, UInt32

from gz_course.sim.bridge.ros_gz_bridge.fields import COLOR, HEADER, Fields, message_pair, plain

for _ros_class, _gz_type in (
    (Bool, "gz.msgs.Boolean"),
    (Float32, "gz.msgs.Float"),
    (Float64, "gz.msgs.Double"),
    (Int32, "gz.msgs.Int32"),
    (UInt32, "gz.msgs.UInt32"),
    (String, "gz.msgs.StringMsg"),
):
    message_pair(f"std_msgs/msg/{_ros_class.__name__}", _gz_type, Fields(_ros_class, **plain("data")))
message_pair("std_msgs/msg/Empty", "gz.msgs.Empty", Fields(Empty))
message_pair("std_msgs/msg/Header", "gz.msgs.Header", HEADER)
message_pair("std_msgs/msg/ColorRGBA", "gz.msgs.Color", COLOR)
