"""Descriptions of message pairs, from which both directions of a conversion follow.

A file in `convert/` describes a message as a `Part` (two functions) or as `Fields` (a list of corresponding fields),
and adds it to the table of type pairs with `message_pair`. A part can contain other parts.
"""

from __future__ import annotations

import operator
from array import array
from collections.abc import Callable, Mapping
from typing import Any, Protocol

from std_msgs.msg import ColorRGBA, Header

from gz_course.sim.bridge.ros_gz_bridge.blank import blank
from gz_course.sim.bridge.ros_gz_bridge.header import copy_header, fill_header
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import ConversionError, add_pair
from gz_course.sim.gz.msgs import message_class


class Kind(Protocol):
    """The conversion of one field of a message."""

    def get(self, gz: Any, name: str) -> Any:
        """Return the ROS value of the field `name` of a Gazebo message."""

    def put(self, value: Any, gz: Any, name: str) -> None:
        """Write a ROS value into the field `name` of a Gazebo message."""


class Plain:
    """A number, text or truth value, converted by a function in each direction; copied by default."""

    def __init__(
        self, to_ros: Callable[[Any], Any] = lambda value: value, to_gz: Callable[[Any], Any] = lambda value: value
    ) -> None:
        self._to_ros = to_ros
        self._to_gz = to_gz

    def get(self, gz: Any, name: str) -> Any:
        return self._to_ros(getattr(gz, name))

    def put(self, value: Any, gz: Any, name: str) -> None:
        setattr(gz, name, self._to_gz(value))


class Part:
    """A message, or a message inside another one.

    `fill(gz, ros)` writes a Gazebo message into a new ROS message, `copy(ros, gz)` a ROS message into a new Gazebo
    message. Both raise `ConversionError` for a message that the other side cannot hold.
    """

    def __init__(self, ros_class: Any, fill: Callable[[Any, Any], None], copy: Callable[[Any, Any], None]) -> None:
        self._ros_class = ros_class
        self.fill = fill
        self.copy = copy

    def to_ros(self, gz: Any) -> Any:
        """Return a new ROS message."""
        ros = blank(self._ros_class)
        self.fill(gz, ros)
        return ros

    def get(self, gz: Any, name: str) -> Any:
        return self.to_ros(getattr(gz, name))

    def put(self, value: Any, gz: Any, name: str) -> None:
        """Fill the Gazebo message `name`, which counts as set even if every field is zero."""
        inside = getattr(gz, name)
        inside.SetInParent()
        self.copy(value, inside)


class Each:
    """A list of messages of one kind."""

    def __init__(self, part: Part) -> None:
        self._part = part

    def get(self, gz: Any, name: str) -> list[Any]:
        return [self._part.to_ros(item) for item in getattr(gz, name)]

    def put(self, value: Any, gz: Any, name: str) -> None:
        items = getattr(gz, name)
        for item in value:
            self._part.copy(item, items.add())


class Items:
    """A list of numbers or texts; `make` builds the ROS list from the values."""

    def __init__(self, make: Callable[[Any], Any]) -> None:
        self._make = make

    def get(self, gz: Any, name: str) -> Any:
        return self._make(getattr(gz, name))

    def put(self, value: Any, gz: Any, name: str) -> None:
        getattr(gz, name).extend(value)


class Fields(Part):
    """Two messages whose fields correspond; `kinds` says for each ROS field how it is converted.

    `renamed` gives the Gazebo names that differ from the ROS ones. Fields that are not listed keep their default on
    both sides.
    """

    def __init__(self, ros_class: Any, renamed: Mapping[str, str] | None = None, /, **kinds: Kind) -> None:
        super().__init__(ros_class, self._fill, self._copy)
        self._kinds = [(name, (renamed or {}).get(name, name), kind) for name, kind in kinds.items()]

    def _fill(self, gz: Any, ros: Any) -> None:
        for ros_name, gz_name, kind in self._kinds:
            setattr(ros, ros_name, kind.get(gz, gz_name))

    def _copy(self, ros: Any, gz: Any) -> None:
        for ros_name, gz_name, kind in self._kinds:
            kind.put(getattr(ros, ros_name), gz, gz_name)


def stamped(ros_class: Any, field: str, part: Part, gz_header: str = "header") -> Part:
    """Return the part of a ROS message that holds a header and, in `field`, what `part` describes.

    `gz_header` is the path of the header in the Gazebo message.
    """
    header_of = operator.attrgetter(gz_header)

    def fill(gz: Any, ros: Any) -> None:
        fill_header(header_of(gz), ros.header)
        part.fill(gz, getattr(ros, field))

    def copy(ros: Any, gz: Any) -> None:
        copy_header(ros.header, header_of(gz))
        part.copy(getattr(ros, field), gz)

    return Part(ros_class, fill, copy)


def message_pair(ros_type: str, gz_type: str, part: Part, fault: Callable[[Any], str | None] | None = None) -> None:
    """Add the pair that `part` describes to the table of type pairs; `fault` is explained at `TypePair`."""
    gz_class = message_class(gz_type)

    def to_gz(ros: Any) -> Any:
        gz = gz_class()
        part.copy(ros, gz)
        return gz

    add_pair(ros_type, gz_type, to_ros=part.to_ros, to_gz=to_gz, fault=fault)


def plain(*names: str) -> dict[str, Kind]:
    """Return the kinds of fields that are copied."""
    return dict.fromkeys(names, PLAIN)


def _uint8(number: int) -> int:
    if not 0 <= number <= 255:
        raise ConversionError(f"the number {number} does not fit the 8 bits that ROS has for it")
    return number


def _copy_color(source: Any, target: Any) -> None:
    target.r, target.g, target.b, target.a = source.r, source.g, source.b, source.a


PLAIN = Plain()
ENUM = Plain(to_ros=_uint8)
"""An enumeration with the same numbers on both sides; ROS keeps it in a `uint8`."""
TEXTS = Items(list)
FLOATS = Items(lambda numbers: array("f", numbers))
DOUBLES = Items(lambda numbers: array("d", numbers))
INT32S = Items(lambda numbers: array("i", numbers))
HEADER = Part(Header, fill_header, copy_header)
COLOR = Part(ColorRGBA, _copy_color, _copy_color)
"""Red, green, blue and opacity, each 0 to 1."""
