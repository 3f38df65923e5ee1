"""ROS parameters of a program, with their defaults."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.ros_program.errors import UsageError

if TYPE_CHECKING:
    from rclpy.node import Node

TYPE_WORDS = {str: "a text", bool: "true or false", int: "a whole number", float: "a number"}
OF_EVERY_NODE = {"use_sim_time", "start_type_description_service"}


def read_parameters(node: Node, defaults: Mapping[str, Any]) -> dict[str, Any]:
    """Return the value of each parameter in `defaults`, and warn of parameters that are not among them.

    Raises UsageError if a value has another type than its default; a whole number is good for a float.
    """
    values = dict(defaults)
    for name, parameter in node.get_parameters_by_prefix("").items():
        value = parameter.value
        if name not in values:
            if name not in OF_EVERY_NODE and not name.startswith("qos_overrides."):
                node.get_logger().warning(
                    f"the parameter {name} is not known here and changes nothing; there are {', '.join(defaults)}"
                )
        elif value is not None:
            kind = type(defaults[name])
            if type(value) is not kind and not (kind is float and type(value) is int):
                raise UsageError(f"the parameter {name} must be {TYPE_WORDS[kind]}, not {repr(value)[:80]}")
            values[name] = kind(value)
    return values
