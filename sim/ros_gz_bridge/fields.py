"""Pairs whose fields correspond one to one, declared as a list of fields instead of two functions.

The files in ``convert/`` describe a message with ``Fields`` (which may stand inside another) and enter it with
``add_fields``. What needs more than copying (images, scans, covariances) has functions of its own there.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable, Mapping
from typing import Any, Protocol

from std_msgs.msg import ColorRGBA

from gz_course.sim.gz.msgs import message_class
from gz_course.sim.ros_gz_bridge.blank import blank
from gz_course.sim.ros_gz_bridge.header import header_to_gz, header_to_ros
from gz_course.sim.ros_gz_bridge.type_pairs import ConversionError, add_pair


class Kind(Protocol):
    """How the value of one field travels."""

    def get(self, gz: Any, name: str) -> Any:
        """The ROS value of the field ``name`` of a Gazebo message."""

    def put(self, value: Any, gz: Any, name: str) -> None:
        """Write a ROS value into the field ``name`` of a Gazebo message."""


class Plain:
    """A number, text or truth value; perhaps changed on its way."""

    def __init__(
        self, to_ros: Callable[[Any], Any] = lambda value: value, to_gz: Callable[[Any], Any] = lambda value: value
    ) -> None:
        self._to_ros = to_ros
        self._to_gz = to_gz

    def get(self, gz: Any, name: str) -> Any:
        """Read and change."""
        return self._to_ros(getattr(gz, name))

    def put(self, value: Any, gz: Any, name: str) -> None:
        """Change and write."""
        setattr(gz, name, self._to_gz(value))


class Part:
    """A message inside the message: ``to_ros`` makes a ROS message, ``to_gz`` writes into a Gazebo one."""

    def __init__(self, to_ros: Callable[[Any], Any], to_gz: Callable[[Any, Any], None]) -> None:
        self.to_ros = to_ros
        self.to_gz = to_gz

    def get(self, gz: Any, name: str) -> Any:
        """A new ROS message."""
        return self.to_ros(getattr(gz, name))

    def put(self, value: Any, gz: Any, name: str) -> None:
        """Fill the Gazebo message; it counts as given even if every field is zero."""
        inside = getattr(gz, name)
        inside.SetInParent()
        self.to_gz(value, inside)


class Each:
    """A list of messages of one kind."""

    def __init__(self, part: Part) -> None:
        self._part = part

    def get(self, gz: Any, name: str) -> list[Any]:
        """One ROS message for each."""
        return [self._part.to_ros(item) for item in getattr(gz, name)]

    def put(self, value: Any, gz: Any, name: str) -> None:
        """One Gazebo message for each."""
        items = getattr(gz, name)
        for item in value:
            self._part.to_gz(item, items.add())


class Numbers:
    """A list of numbers; ``code`` is the type code of Python's ``array`` that ROS keeps them in."""

    def __init__(self, code: str) -> None:
        self._code = code

    def get(self, gz: Any, name: str) -> array[Any]:
        """An array."""
        return array(self._code, getattr(gz, name))

    def put(self, value: Any, gz: Any, name: str) -> None:
        """A repeated field."""
        getattr(gz, name).extend(value)


class Texts:
    """A list of strings."""

    def get(self, gz: Any, name: str) -> list[str]:
        """A list."""
        return list(getattr(gz, name))

    def put(self, value: Any, gz: Any, name: str) -> None:
        """A repeated field."""
        getattr(gz, name).extend(value)


class Fields(Part):
    """Two messages whose fields correspond: for each ROS field how it travels.

    ``renamed`` gives the Gazebo names that differ from the ROS ones. Fields that are not listed stay at their
    default on both sides.
    """

    def __init__(self, ros_class: Any, renamed: Mapping[str, str] | None = None, /, **kinds: Kind) -> None:
        super().__init__(self._make, self._fill)
        self._ros_class = ros_class
        self._kinds = [(name, (renamed or {}).get(name, name), kind) for name, kind in kinds.items()]

    def _make(self, gz: Any) -> Any:
        ros = blank(self._ros_class)
        for ros_name, gz_name, kind in self._kinds:
            setattr(ros, ros_name, kind.get(gz, gz_name))
        return ros

    def _fill(self, ros: Any, gz: Any) -> None:
        for ros_name, gz_name, kind in self._kinds:
            kind.put(getattr(ros, ros_name), gz, gz_name)


def add_fields(ros_type: str, gz_type: str, part: Part, fault: Callable[[Any], str | None] | None = None) -> None:
    """Enter the pair that ``part`` describes in the table of type pairs."""
    gz_class = message_class(gz_type)

    def to_gz(ros: Any) -> Any:
        gz = gz_class()
        part.to_gz(ros, gz)
        return gz

    add_pair(ros_type, gz_type, to_ros=part.to_ros, to_gz=to_gz, fault=fault)


def _uint8(number: int) -> int:
    if not 0 <= number <= 255:
        raise ConversionError(f"the number {number} does not fit the 8 bits that ROS has for it")
    return number


def _color_to_gz(ros: ColorRGBA, gz: Any) -> None:
    gz.r, gz.g, gz.b, gz.a = ros.r, ros.g, ros.b, ros.a


PLAIN = Plain()
ENUM = Plain(to_ros=_uint8)
"""An enumeration with the same numbers on both sides; ROS keeps it in a ``uint8``."""
FLOATS, DOUBLES, INT32S, TEXTS = Numbers("f"), Numbers("d"), Numbers("i"), Texts()
HEADER = Part(header_to_ros, header_to_gz)
COLOR = Part(lambda gz: ColorRGBA(r=gz.r, g=gz.g, b=gz.b, a=gz.a), _color_to_gz)
