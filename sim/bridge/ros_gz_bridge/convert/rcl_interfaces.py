"""rcl_interfaces: ParameterValue, a value whose type is known only when it arrives.

Source: rcl_interfaces/msg/ParameterType.msg, https://github.com/ros2/rcl_interfaces; gz/msgs/any.proto
"""

from __future__ import annotations

from typing import Any

from rcl_interfaces.msg import ParameterType, ParameterValue

from gz_course.sim.bridge.ros_gz_bridge.fields import Part, message_pair
from gz_course.sim.bridge.ros_gz_bridge.remarks import remark
from gz_course.sim.gz.msgs.any_pb2 import Any as GzAny

_INT32 = (-(2**31), 2**31 - 1)
# Gazebo type and its field, ROS type and its field.
_TYPES = (
    (GzAny.BOOLEAN, "bool_value", ParameterType.PARAMETER_BOOL, "bool_value"),
    (GzAny.INT32, "int_value", ParameterType.PARAMETER_INTEGER, "integer_value"),
    (GzAny.DOUBLE, "double_value", ParameterType.PARAMETER_DOUBLE, "double_value"),
    (GzAny.STRING, "string_value", ParameterType.PARAMETER_STRING, "string_value"),
)
_ROS_NAMES = {value: name for name, value in vars(ParameterType).items() if name.startswith("PARAMETER_")}


def fill_value(gz: Any, ros: ParameterValue) -> bool:
    """Write a `gz.msgs.Any`; return False for a type that ROS parameters do not have (a pose, a colour)."""
    for gz_type, gz_field, ros_type, ros_field in _TYPES:
        if gz.type == gz_type:
            ros.type = ros_type
            setattr(ros, ros_field, getattr(gz, gz_field))
            return True
    return bool(gz.type == GzAny.NONE)


def copy_value(ros: ParameterValue, gz: Any) -> bool:
    """Write into a `gz.msgs.Any`, clamping integers to 32 bits; return False for a list, which Any cannot hold."""
    if ros.type == ParameterType.PARAMETER_NOT_SET:
        gz.type = GzAny.NONE
        return True
    for gz_type, gz_field, ros_type, ros_field in _TYPES:
        if ros.type == ros_type:
            value = getattr(ros, ros_field)
            gz.type = gz_type
            setattr(gz, gz_field, min(max(value, _INT32[0]), _INT32[1]) if gz_type == GzAny.INT32 else value)
            return True
    return False


def _fill(gz: Any, ros: ParameterValue) -> None:
    if not fill_value(gz, ros):
        name = GzAny.ValueType.Name(gz.type) if gz.type in GzAny.ValueType.values() else f"number {gz.type}"
        remark(f"a ROS parameter cannot hold a gz.msgs.Any of type {name}; it is sent without a value")


def _copy(ros: ParameterValue, gz: Any) -> None:
    if not copy_value(ros, gz):
        name = _ROS_NAMES.get(ros.type, f"number {ros.type}")
        gz.type = GzAny.NONE
        remark(f"gz.msgs.Any cannot hold a parameter of type {name}; it is sent without a value")


message_pair("rcl_interfaces/msg/ParameterValue", "gz.msgs.Any", Part(ParameterValue, _fill, _copy))
