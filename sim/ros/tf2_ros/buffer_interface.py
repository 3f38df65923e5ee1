"""`BufferInterface`: what transforms stamped messages, with the functions that are registered for their types.

A package such as `tf2_geometry_msgs` registers its functions when it is imported.

Source: tf2_ros_py/tf2_ros/buffer_interface.py of https://github.com/ros2/geometry2
"""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import Any, ClassVar

from geometry_msgs.msg import TransformStamped
from rclpy.duration import Duration
from rclpy.time import Time
from std_msgs.msg import Header

Transform = Callable[[Any, TransformStamped], Any]
Convert = Callable[[Any], Any]

NOW = Duration()


class BufferInterface:
    """Transforms messages with the transforms that a subclass looks up."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self,
        object_stamped: Any,
        target_frame: str,
        timeout: Duration = NOW,
        new_type: Any = None,
    ) -> Any:
        """Return a stamped message in another frame, and converted to `new_type` if that is given."""
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        transform = self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout)
        done = do_transform(object_stamped, transform)
        return done if new_type is None else convert(done, new_type)

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: Time,
        fixed_frame: str,
        timeout: Duration = NOW,
        new_type: Any = None,
    ) -> Any:
        """Return a stamped message in another frame at another time; `fixed_frame` does not move in between."""
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        transform = self.lookup_transform_full(
            target_frame, target_time, header.frame_id, header.stamp, fixed_frame, timeout
        )
        done = do_transform(object_stamped, transform)
        return done if new_type is None else convert(done, new_type)

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time,
        timeout: Duration = NOW,
    ) -> TransformStamped:
        raise NotImplementedException

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = NOW,
    ) -> TransformStamped:
        raise NotImplementedException

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time,
        timeout: Duration = NOW,
    ) -> Any:
        raise NotImplementedException

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = NOW,
    ) -> Any:
        raise NotImplementedException


def Stamped(obj: Any, stamp: Any, frame_id: str) -> Any:
    """Give an object a header, and return it."""
    obj.header = Header(frame_id=frame_id, stamp=stamp)
    return obj


class TypeException(Exception):
    """No function is registered for a type."""

    def __init__(self, errstr: str) -> None:
        super().__init__(errstr)
        self.errstr = errstr


class NotImplementedException(Exception):
    """A subclass of BufferInterface does not look up transforms."""

    def __init__(self) -> None:
        self.errstr = "CanTransform or LookupTransform not implemented"
        super().__init__(self.errstr)


class TransformRegistration:
    """The functions that transform messages, by type; all objects of this class share them."""

    _transforms: ClassVar[dict[Any, Transform]] = {}

    def print_me(self) -> None:
        print(self._transforms)

    def add(self, key: Any, callback: Transform) -> None:
        self._transforms[key] = callback

    def get(self, key: Any) -> Transform:
        """Return the function for a type. Raises TypeException if there is none."""
        return _registered(self._transforms, key)


class ConvertRegistration:
    """The functions that convert objects to and from messages, or directly; all objects of this class share them."""

    _from_msg: ClassVar[dict[Any, Convert]] = {}
    _to_msg: ClassVar[dict[Any, Convert]] = {}
    _direct: ClassVar[dict[Any, Convert]] = {}

    def add_from_msg(self, key: Any, callback: Convert) -> None:
        self._from_msg[key] = callback

    def add_to_msg(self, key: Any, callback: Convert) -> None:
        self._to_msg[key] = callback

    def add_convert(self, key: tuple[Any, Any], callback: Convert) -> None:
        self._direct[key] = callback

    def get_from_msg(self, key: Any) -> Convert:
        return _registered(self._from_msg, key)

    def get_to_msg(self, key: Any) -> Convert:
        return _registered(self._to_msg, key)

    def get_convert(self, key: tuple[Any, Any]) -> Convert:
        return _registered(self._direct, key)


def convert(a: Any, b_type: Any) -> Any:
    """Return an object as another type: directly, as a copy if it has that type, or by way of a message."""
    registration = ConvertRegistration()
    try:
        directly = registration.get_convert((type(a), b_type))
    except TypeException:
        if type(a) is b_type:
            return deepcopy(a)
        return registration.get_from_msg(b_type)(registration.get_to_msg(type(a))(a))
    return directly(a)


def _registered(functions: dict[Any, Any], key: Any) -> Any:
    if key not in functions:
        raise TypeException(f"Type {key} is not loaded or supported")
    return functions[key]
