"""tf2_msgs: TFMessage, the transforms between frames.

Every pose of the Gazebo message brings its own header and the name of its frame; the header of the whole list has no
field in ROS.

Source: ros_gz_bridge/src/convert/tf2_msgs.cpp
"""

from __future__ import annotations

from tf2_msgs.msg import TFMessage

from gz_course.sim.ros_gz_bridge.convert.geometry_msgs.poses import TRANSFORM_STAMPED
from gz_course.sim.ros_gz_bridge.fields import Each, Fields, message_pair

message_pair(
    "tf2_msgs/msg/TFMessage",
    "gz.msgs.Pose_V",
    Fields(TFMessage, {"transforms": "pose"}, transforms=Each(TRANSFORM_STAMPED)),
)
