"""ParamVec: named values. Gazebo nests its parameters; ROS has one list, whose names tell where a value was."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterValue
from ros_gz_interfaces.msg import ParamVec

from gz_course.sim.gz.msgs.param_pb2 import Param
from gz_course.sim.gz.msgs.param_v_pb2 import Param_V
from gz_course.sim.ros_gz_bridge.convert.rcl_interfaces import copy_value, value_to_ros
from gz_course.sim.ros_gz_bridge.header import header_to_gz, header_to_ros
from gz_course.sim.ros_gz_bridge.type_pairs import ConversionError, type_pair

_DEEPEST = 50  # protobuf itself refuses to read more than 100 messages in one another


def _flat(gz: Any, prefix: str = "") -> Iterator[Parameter]:
    """The parameters of a ``Param`` and of its children, in the order of their names."""
    for name in sorted(gz.params):
        # A value ROS has no type for (a pose, a colour) is a parameter that is not set.
        yield Parameter(name=prefix + name, value=value_to_ros(gz.params[name]) or ParameterValue())
    for number, child in enumerate(gz.children):
        yield from _flat(child, f"{prefix}child_{number}/")


def _fill(params: Iterable[tuple[str, ParameterValue]], gz: Any, depth: int = 0) -> None:
    """Write named values into a ``Param``; names that begin with ``child_0/`` go to its children."""
    if depth > _DEEPEST:
        raise ConversionError(f"the parameters are nested deeper than {_DEEPEST} times")
    own, children = _grouped(params, "child")
    for name, value in own:
        if not copy_value(value, gz.params[name]):
            raise ConversionError(f"the parameter {name} is a list; gz.msgs.Param holds single values only")
    for child in children:
        _fill(child, gz.children.add(), depth + 1)


def _grouped(
    params: Iterable[tuple[str, ParameterValue]], word: str
) -> tuple[list[tuple[str, ParameterValue]], list[list[tuple[str, ParameterValue]]]]:
    """Names without ``word_<number>/``, and those with it (cut off), by number."""
    plain: list[tuple[str, ParameterValue]] = []
    groups: dict[int, list[tuple[str, ParameterValue]]] = {}
    for name, value in params:
        if match := re.fullmatch(rf"{word}_([0-9]{{1,9}})/(.*)", name, re.DOTALL):
            groups.setdefault(int(match[1]), []).append((match[2], value))
        else:
            plain.append((name, value))
    return plain, [groups[number] for number in sorted(groups)]


@type_pair("ros_gz_interfaces/msg/ParamVec", "gz.msgs.Param")
class ParamPair:
    """One set of parameters; those of its children are named ``child_0/name``."""

    @staticmethod
    def to_ros(gz: Any) -> ParamVec:
        """Gazebo to ROS."""
        return ParamVec(header=header_to_ros(gz.header), params=list(_flat(gz)))

    @staticmethod
    def to_gz(ros: ParamVec) -> Any:
        """ROS to Gazebo."""
        gz = Param()
        header_to_gz(ros.header, gz.header)
        _fill(((param.name, param.value) for param in ros.params), gz)
        return gz


@type_pair("ros_gz_interfaces/msg/ParamVec", "gz.msgs.Param_V")
class ParamVPair:
    """Several sets of parameters, named ``param_0/name``; names without that make a first set of their own."""

    @staticmethod
    def to_ros(gz: Any) -> ParamVec:
        """Gazebo to ROS."""
        params = [param for number, one in enumerate(gz.param) for param in _flat(one, f"param_{number}/")]
        return ParamVec(header=header_to_ros(gz.header), params=params)

    @staticmethod
    def to_gz(ros: ParamVec) -> Any:
        """ROS to Gazebo."""
        gz = Param_V()
        header_to_gz(ros.header, gz.header)
        plain, sets = _grouped(((param.name, param.value) for param in ros.params), "param")
        for params in [*([plain] if plain else []), *sets]:
            _fill(params, gz.param.add())
        return gz
