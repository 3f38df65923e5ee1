"""Functions that transform messages of geometry_msgs, in place of the `tf2_geometry_msgs` package.

Importing it registers them, so that `Buffer.transform` takes these messages. As there, the message classes are names of
this package, too.

Source: tf2_geometry_msgs/src/tf2_geometry_msgs/tf2_geometry_msgs.py of https://github.com/ros2/geometry2
"""

from geometry_msgs.msg import (
    Point,
    Point32,
    PointStamped,
    PolygonStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Vector3Stamped,
)

from gz_course.sim.ros.tf2_geometry_msgs.tf2_geometry_msgs import (
    do_transform_point,
    do_transform_polygon_stamped,
    do_transform_pose,
    do_transform_pose_stamped,
    do_transform_pose_with_covariance_stamped,
    do_transform_twist,
    do_transform_twist_stamped,
    do_transform_vector3,
    do_transform_wrench,
    do_transform_wrench_stamped,
    from_msg_msg,
    to_msg_msg,
    transform_covariance,
)

__all__ = [
    "Point",
    "Point32",
    "PointStamped",
    "PolygonStamped",
    "Pose",
    "PoseStamped",
    "PoseWithCovarianceStamped",
    "TransformStamped",
    "Vector3Stamped",
    "do_transform_point",
    "do_transform_polygon_stamped",
    "do_transform_pose",
    "do_transform_pose_stamped",
    "do_transform_pose_with_covariance_stamped",
    "do_transform_twist",
    "do_transform_twist_stamped",
    "do_transform_vector3",
    "do_transform_wrench",
    "do_transform_wrench_stamped",
    "from_msg_msg",
    "to_msg_msg",
    "transform_covariance",
]
