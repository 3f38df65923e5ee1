"""Errors of tf2, as a node raises them, and what is said of them."""

import pytest
from builtin_interfaces.msg import Time as Stamp
from geometry_msgs.msg import Point, PointStamped, TransformStamped
from rclpy.duration import Duration
from rclpy.time import Time
from tf2_geometry_msgs import do_transform_point
from tf2_ros import Buffer, TransformListener

from gz_course.grader.feedback.errors.python_errors import meaning


def filled():
    buffer = Buffer()
    for second in (5, 6):
        transform = TransformStamped(child_frame_id="robot")
        transform.header.frame_id = "odom"
        transform.header.stamp = Stamp(sec=second)
        transform.transform.rotation.w = 1.0
        buffer.set_transform(transform, "test")
    return buffer


MISTAKES = {
    "no frame called laser has been heard of": lambda: filled().lookup_transform("odom", "laser", Time()),
    "it comes later than the data of its time": lambda: filled().lookup_transform("odom", "robot", Time(seconds=9)),
    "older than every transform": lambda: filled().lookup_transform("odom", "robot", Time(seconds=1)),
    "the call is lookup_transform(target_frame, source_frame, time)": lambda: filled().lookup_transform(
        "odom", "robot"
    ),
    "a Buffer has lookup_transform": lambda: filled().lookupTransform("odom", "robot", Time()),
    "ask the buffer": lambda: TransformListener.lookup_transform,
    "the call is TransformListener(buffer, node)": lambda: TransformListener(Buffer()),
    "first the PointStamped, then": lambda: do_transform_point(TransformStamped(), PointStamped()),
    "a Point alone says neither frame nor time": lambda: do_transform_point(Point(), TransformStamped()),
    "the time of a lookup is no number": lambda: filled().lookup_transform("odom", "robot", 5.0),
    "import tf2_geometry_msgs teaches it": lambda: filled().transform(Point(), "odom"),
    "would lie before the time 0": lambda: Time(seconds=1) - Duration(seconds=2),
    "from_msg belongs to the class of rclpy": lambda: Time.from_msg(),
}


@pytest.mark.parametrize("words", MISTAKES)
def test_what_to_change_is_said(words):
    with pytest.raises(Exception) as caught:
        MISTAKES[words]()
    error = f"{type(caught.value).__module__}.{type(caught.value).__qualname__}: {caught.value}".splitlines()[0]
    if words == "ask the buffer":
        error = "AttributeError: 'TransformListener' object has no attribute 'lookup_transform'"
    said = meaning(error.removeprefix("builtins."))
    assert words in said, (error, said)


def test_other_errors_are_none_of_tf2():
    assert "transform" not in meaning("ZeroDivisionError: division by zero")
