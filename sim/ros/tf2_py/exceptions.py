"""The exceptions of tf2; a traceback shows them as `tf2.LookupException`, as those of the compiled package.

Source: tf2_py/src/tf2_py.cpp of https://github.com/ros2/geometry2
"""

from __future__ import annotations


class TransformException(Exception):
    """Any failure to find a transform."""

    __module__ = "tf2"


class ConnectivityException(TransformException):
    """Two frames are not in the same tree."""

    __module__ = "tf2"


class LookupException(TransformException):
    """A frame does not exist, or the tree has a loop."""

    __module__ = "tf2"


class ExtrapolationException(TransformException):
    """The time lies outside the times for which transforms are known."""

    __module__ = "tf2"


class InvalidArgumentException(TransformException):
    """A frame name is empty or begins with a slash."""

    __module__ = "tf2"


class TimeoutException(TransformException):
    """A transform did not become available in time."""

    __module__ = "tf2"
