"""rcl_interfaces: ParameterValue, one value of a type that is known only when it arrives."""

from __future__ import annotations

from typing import Any

from rcl_interfaces.msg import ParameterType, ParameterValue

from gz_course.sim.gz.msgs.any_pb2 import Any as GzAny
from gz_course.sim.ros_gz_bridge.type_pairs import ConversionError, type_pair

_INT32 = (-(2**31), 2**31 - 1)
# Gazebo type, its field, ROS type, its field: what both sides have.
_TYPES = (
    (GzAny.BOOLEAN, "bool_value", ParameterType.PARAMETER_BOOL, "bool_value"),
    (GzAny.INT32, "int_value", ParameterType.PARAMETER_INTEGER, "integer_value"),
    (GzAny.DOUBLE, "double_value", ParameterType.PARAMETER_DOUBLE, "double_value"),
    (GzAny.STRING, "string_value", ParameterType.PARAMETER_STRING, "string_value"),
)
_ROS_NAMES = {value: name for name, value in vars(ParameterType).items() if name.startswith("PARAMETER_")}


def value_to_ros(gz: Any) -> ParameterValue | None:
    """A ``gz.msgs.Any`` as a parameter's value; None for a type ROS parameters do not have (a pose, a colour)."""
    if gz.type == GzAny.NONE:
        return ParameterValue()
    for gz_type, gz_field, ros_type, ros_field in _TYPES:
        if gz.type == gz_type:
            return ParameterValue(type=ros_type, **{ros_field: getattr(gz, gz_field)})
    return None


def copy_value(ros: ParameterValue, gz: Any) -> bool:
    """Write into a ``gz.msgs.Any``; integers beyond 32 bits stop at the limit. False for a list: Any has none."""
    if ros.type == ParameterType.PARAMETER_NOT_SET:
        gz.type = GzAny.NONE
        return True
    for gz_type, gz_field, ros_type, ros_field in _TYPES:
        if ros.type == ros_type:
            value = getattr(ros, ros_field)
            if gz_type == GzAny.INT32:
                value = min(max(value, _INT32[0]), _INT32[1])
            gz.type = gz_type
            setattr(gz, gz_field, value)
            return True
    return False


@type_pair("rcl_interfaces/msg/ParameterValue", "gz.msgs.Any")
class ParameterValuePair:
    """A truth value, an integer (32 bits), a double or a string."""

    @staticmethod
    def to_ros(gz: Any) -> ParameterValue:
        """Gazebo to ROS."""
        if (ros := value_to_ros(gz)) is None:
            name = GzAny.ValueType.Name(gz.type) if gz.type in GzAny.ValueType.values() else f"number {gz.type}"
            raise ConversionError(f"a ROS parameter cannot hold a gz.msgs.Any of type {name}")
        return ros

    @staticmethod
    def to_gz(ros: ParameterValue) -> Any:
        """ROS to Gazebo."""
        gz = GzAny()
        if not copy_value(ros, gz):
            name = _ROS_NAMES.get(ros.type, f"number {ros.type}")
            raise ConversionError(f"gz.msgs.Any cannot hold a parameter of type {name}")
        return gz
