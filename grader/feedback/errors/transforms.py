"""Errors of tf2: frames that are not there, times that are too early or too late, points without a frame.

Source: the error texts of tf2 and tf2_ros (ROS 2 Jazzy), and the signatures of Buffer, TransformListener and
do_transform_point.
"""

from __future__ import annotations

from gz_course.grader.feedback.errors import explanation, listed, table

BEFORE = ("syntax",)

CATCH = "Catch TransformException of tf2_ros, keep the message, and try again when the next one comes"
# Pattern of the error -> what to change. {0} is the group of the pattern.
MEANINGS = table(r"""
LookupException.*?\"?([\w/]+)\"? passed to lookupTransform argument \w+_frame does not exist
    that transform is not there (yet): no frame called {0} has been heard of. If it has another name, ros2 run tf2_tools
    view_frames draws it. If not, it comes later than the first data. Catch TransformException of tf2_ros, keep the
    message, and try again when the next one comes
ExtrapolationException.*into the past
    the time that is asked for is older than every transform the buffer holds; Time() stands for the latest transform,
    and the time of a message is Time.from_msg(message.header.stamp)
ExtrapolationException.*into the future
    that transform is not there (yet): it comes later than the data of its time. Catch TransformException of tf2_ros,
    keep the message, and try again when the next one comes
TypeException: .*is not loaded or supported
    Buffer.transform() knows no type of message by itself: import tf2_geometry_msgs teaches it those of geometry_msgs,
    as long as they are stamped
'Buffer' object has no attribute '(?:lookup\w*|get\w*|transform\w+|waitFor\w*)'
    a Buffer has lookup_transform(target_frame, source_frame, time), can_transform(...) and transform(...)
'TransformListener' object has no attribute '(\w+)'
    the listener only fills the buffer: ask the buffer, buffer.lookup_transform(target_frame, source_frame, time)
(?:lookup_transform|can_transform)\(\) (?:missing \d|takes)
    the call is lookup_transform(target_frame, source_frame, time), with Time() for the latest transform, or
    Time.from_msg(message.header.stamp)
BufferInterface\.transform\(\) (?:missing|takes)
    the call is buffer.transform(stamped_message, 'TARGET_FRAME')
do_transform_\w+\(\) (?:missing|takes)|'TransformStamped' object has no attribute '(?:point|pose|vector)'
    the call is do_transform_point(point, transform): first the PointStamped, then what lookup_transform returned
'Point' object has no attribute '(?:point|header)'
    a PointStamped belongs here, which has a header and a point: a Point alone says neither frame nor time
TypeError: time must have sec and nanosec
    the time of a lookup is no number: Time.from_msg(message.header.stamp), or Time() for the latest transform
ValueError: (?:Subtraction|Addition) leads to negative time
    the result would lie before the time 0: simulated time begins at 0, and the first messages come right then
cannot import name 'do_transform_(\w+)'
    it is in another package: from tf2_geometry_msgs import do_transform_{0}
No module named '(tf_transformations|transforms3d)'
    {0} is not installed: do_transform_point of tf2_geometry_msgs applies a transform, and the heading of a quaternion q
    is 2 * math.atan2(q.z, q.w) if nothing is tilted
Time\.from_msg\(\) missing|'Time' object has no attribute 'from_msg'
    from_msg belongs to the class of rclpy and takes the stamp: rclpy.time.Time.from_msg(message.header.stamp)
TransformListener\.__init__\(\) missing
    the call is TransformListener(buffer, node), self.buffer and self within a node
""")


@explanation
def transform_fault(error: str, code: str) -> str:
    """Return what to change after an error about transforms; empty if it is about something else."""
    return listed(error, MEANINGS)
