"""Blank messages equal those of the constructor and share no mutable value."""

from array import array

import numpy as np
import pytest
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo, LaserScan

from gz_course.sim.bridge.ros_gz_bridge.blank import blank
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import pairs

CLASSES = sorted({pair.ros_class for pair in pairs()}, key=str)


def changeable(message):
    """Return the identities of all mutable values in a message."""
    values = [getattr(message, slot) for slot in message.__slots__]
    for value in values:
        if hasattr(value, "get_fields_and_field_types"):
            yield from changeable(value)
        if hasattr(value, "get_fields_and_field_types") or isinstance(value, list | array | np.ndarray):
            yield id(value)


@pytest.mark.parametrize("message_class", CLASSES, ids=lambda each: each.__name__)
def test_it_is_what_the_constructor_makes(message_class):
    made, built, again = blank(message_class), message_class(), blank(message_class)
    assert type(made) is message_class
    assert repr(made) == repr(built)
    for slot in message_class.__slots__:
        assert type(getattr(made, slot)) is type(getattr(built, slot))
    assert len([*changeable(made)]) == len([*changeable(built)])
    assert not {*changeable(made)} & {*changeable(again)}


def test_what_is_written_into_one_is_not_in_the_next():
    scan, odometry, camera = blank(LaserScan), blank(Odometry), blank(CameraInfo)
    scan.ranges.append(1.0)
    scan.header.stamp.sec = 7
    odometry.pose.covariance[3] = 1.0
    odometry.twist.twist.angular.z = 2.0
    camera.k[0] = 1.0
    assert blank(LaserScan) == LaserScan()
    np.testing.assert_array_equal(blank(Odometry).pose.covariance, np.zeros(36))
    assert blank(Odometry).twist.twist.angular.z == 0.0
    np.testing.assert_array_equal(blank(CameraInfo).k, np.zeros(9))


def test_a_message_with_something_unforeseen_is_left_to_its_constructor():
    class Corners:
        __slots__ = ("_points",)

        def __init__(self):
            self._points = [Vector3(), Vector3()]

    made, again = blank(Corners), blank(Corners)
    assert made._points == [Vector3(), Vector3()]
    assert made._points[0] is not again._points[0]


def test_a_part_that_was_filled_stays_with_its_message():
    first = blank(Twist)
    first.linear.x = 1.0
    assert (first.linear.x, blank(Twist).linear.x) == (1.0, 0.0)
