"""Fields that a message does not have: the nearest name, or where it is."""

from __future__ import annotations

import re

from gz_course.grader.feedback.errors import explanation
from gz_course.sim.did_you_mean import nearest_name

BEFORE = ("python_errors",)
# Fields of the messages that beginners meet, for misspelt ones. Source: the packages of common_interfaces.
FIELDS = {
    "LaserScan": (
        "header", "angle_min", "angle_max", "angle_increment", "time_increment", "scan_time", "range_min", "range_max",
        "ranges", "intensities",
    ),
    "Twist": ("linear", "angular"),
    "Vector3": ("x", "y", "z"),
    "Odometry": ("header", "child_frame_id", "pose", "twist"),
    "Header": ("stamp", "frame_id"),
    "String": ("data",), "Float32": ("data",), "Float64": ("data",), "Bool": ("data",), "Int32": ("data",),
    "Int64": ("data",), "UInt8": ("data",), "UInt32": ("data",),
    "Point": ("x", "y", "z"), "Quaternion": ("x", "y", "z", "w"), "Pose": ("position", "orientation"),
    "PoseStamped": ("header", "pose"), "PointStamped": ("header", "point"),
    "TransformStamped": ("header", "child_frame_id", "transform"), "Transform": ("translation", "rotation"),
    "TwistStamped": ("header", "twist"), "PoseWithCovariance": ("pose", "covariance"),
    "TwistWithCovariance": ("twist", "covariance"),
    "Imu": (
        "header", "orientation", "orientation_covariance", "angular_velocity", "angular_velocity_covariance",
        "linear_acceleration", "linear_acceleration_covariance",
    ),
    "Image": ("header", "height", "width", "encoding", "is_bigendian", "step", "data"),
    "CameraInfo": ("header", "height", "width", "distortion_model", "d", "k", "r", "p"),
    "OccupancyGrid": ("header", "info", "data"),
    "MapMetaData": ("map_load_time", "resolution", "width", "height", "origin"),
    "JointState": ("header", "name", "position", "velocity", "effort"),
}  # fmt: skip
# What is looked for one level too high.
INSIDE = {
    ("Odometry", "position"): "pose.pose.position", ("Odometry", "orientation"): "pose.pose.orientation",
    ("Odometry", "linear"): "twist.twist.linear", ("Odometry", "angular"): "twist.twist.angular",
    ("Odometry", "x"): "pose.pose.position.x", ("Odometry", "y"): "pose.pose.position.y",
    ("PoseWithCovariance", "position"): "pose.position", ("PoseWithCovariance", "orientation"): "pose.orientation",
    ("PoseWithCovariance", "x"): "pose.position.x", ("PoseWithCovariance", "y"): "pose.position.y",
    ("TwistWithCovariance", "linear"): "twist.linear", ("TwistWithCovariance", "angular"): "twist.angular",
    ("Pose", "x"): "position.x", ("Pose", "y"): "position.y", ("Twist", "x"): "linear.x", ("Twist", "z"): "angular.z",
    ("Odometry", "stamp"): "header.stamp", ("LaserScan", "stamp"): "header.stamp", ("Imu", "stamp"): "header.stamp",
    ("TransformStamped", "translation"): "transform.translation",
    ("TransformStamped", "rotation"): "transform.rotation",
    ("PoseStamped", "position"): "pose.position", ("PointStamped", "x"): "point.x", ("PointStamped", "y"): "point.y",
    ("OccupancyGrid", "resolution"): "info.resolution", ("OccupancyGrid", "width"): "info.width",
    ("OccupancyGrid", "height"): "info.height", ("OccupancyGrid", "origin"): "info.origin",
    ("OccupancyGrid", "frame_id"): "header.frame_id", ("Transform", "x"): "translation.x",
    ("LaserScan", "frame_id"): "header.frame_id",
}  # fmt: skip
NO_FIELD = re.compile(r"AttributeError: '(\w+)' object has no attribute '(\w+)'")


@explanation
def field(error: str, code: str) -> str:
    """Return the fields of the message whose field is misspelt; empty if it is another error."""
    match = NO_FIELD.search(error)
    if match is None or match.group(1) not in FIELDS:
        return ""
    kind, name = match.groups()
    known = FIELDS[kind]
    if near := nearest_name(name, known) or (known[0] if len(known) == 1 else ""):
        return f"the field of a {kind} is called {near}"
    if path := INSIDE.get((kind, name)):
        return f"a {kind} has the fields {', '.join(known)}; {name} is in .{path}"
    return f"a {kind} has the fields {', '.join(known)}"
