"""Messages of Gazebo Fortress, the older version whose types are called `ignition.msgs.X`.

They have the same bytes as gz.msgs.X, with one exception: later versions inserted covariances between the fields of the
IMU. Its old form is in `proto/fortress/`; gz.transport converts a message that has the other name.
Source: ign-msgs 8, https://github.com/gazebosim/gz-msgs/blob/ign-msgs8/proto/ignition/msgs/imu.proto
"""

from __future__ import annotations

from gz_course.sim.gz.msgs.registry import canonical_name, differs_in_fortress, message_class


def same_type(name: str, other: str) -> bool:
    """Return whether two type names mean the same type, whatever their spelling."""
    return name == other or canonical_name(name) == canonical_name(other)


def converted(data: bytes, from_name: str, to_name: str) -> bytes:
    """Return a serialized message of one spelling of a type in the layout of another; mostly the same bytes.

    Fields that the target does not have (the covariances of an IMU) are dropped. Raises
    google.protobuf.message.DecodeError when the bytes have to be read and cannot be.
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
