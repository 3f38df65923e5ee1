"""tf2_msgs: TFMessage, the transforms between frames."""

from __future__ import annotations

from tf2_msgs.msg import TFMessage

from gz_course.sim.ros_gz_bridge.convert.geometry_msgs.poses import TransformStampedPair, copy_transform_stamped
from gz_course.sim.ros_gz_bridge.fields import Each, Fields, Part, add_fields

# Every pose brings its own header and the name of its frame; the header of the whole list has no place in ROS.
add_fields(
    "tf2_msgs/msg/TFMessage",
    "gz.msgs.Pose_V",
    Fields(
        TFMessage,
        {"transforms": "pose"},
        transforms=Each(Part(TransformStampedPair.to_ros, copy_transform_stamped)),
    ),
)
