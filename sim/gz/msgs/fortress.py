"""Messages of Gazebo Fortress, the older version whose types are called `ignition.msgs.X`.

They have the same bytes as gz.msgs.X, with one exception: later versions inserted covariances between the fields of the
IMU. Its old form is in `proto/fortress/`; gz.transport converts between the two.

Source: https://github.com/gazebosim/gz-msgs/blob/ign-msgs8/proto/ignition/msgs/imu.proto
"""

from __future__ import annotations

from gz_course.sim.gz.msgs.registry import canonical_name, differs_in_fortress, message_class


def same_type(name: str, other: str) -> bool:
    """Return whether two type names mean the same type in any spelling."""
    return name == other or canonical_name(name) == canonical_name(other)


def converted(data: bytes, from_name: str, to_name: str) -> bytes:
    """Convert a serialized message from one spelling of its type to another; mostly the bytes are the same.

    Fields that the target does not have (the covariances of an IMU) are dropped. Raises
    google.protobuf.message.DecodeError if the bytes must be parsed and are invalid.
    """
    if from_name == to_name or not differs_in_fortress(from_name):
        return data
    from_class, to_class = message_class(from_name), message_class(to_name)
    if from_class is to_class:
        return data
    target = to_class()
    for field, value in from_class.FromString(data).ListFields():
        if field.name not in to_class.DESCRIPTOR.fields_by_name:
            continue
        if field.message_type is not None:
            getattr(target, field.name).CopyFrom(value)
        else:
            setattr(target, field.name, value)
    return target.SerializeToString()
