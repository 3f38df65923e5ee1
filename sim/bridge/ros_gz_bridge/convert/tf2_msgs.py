"""tf2_msgs: TFMessage, the transforms between frames.

Every pose of the Gazebo message brings its own header and the name of its frame. The whole list has a header, too, for
which ROS has no field; in a list from ROS it is that of the first transform.

Source: ros_gz_bridge/src/convert/tf2_msgs.cpp
"""

from __future__ import annotations

from typing import Any

from tf2_msgs.msg import TFMessage

from gz_course.sim.bridge.ros_gz_bridge.convert.geometry_msgs.poses import TRANSFORM_STAMPED
from gz_course.sim.bridge.ros_gz_bridge.fields import Each, Fields, Part, message_pair
from gz_course.sim.bridge.ros_gz_bridge.header import copy_header

_TRANSFORMS = Fields(TFMessage, {"transforms": "pose"}, transforms=Each(TRANSFORM_STAMPED))


def _copy(ros: TFMessage, gz: Any) -> None:
    _TRANSFORMS.copy(ros, gz)
    if ros.transforms:
        copy_header(ros.transforms[0].header, gz.header)


message_pair("tf2_msgs/msg/TFMessage", "gz.msgs.Pose_V", Part(TFMessage, _TRANSFORMS.fill, _copy))
