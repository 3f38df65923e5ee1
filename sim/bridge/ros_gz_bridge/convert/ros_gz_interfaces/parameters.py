"""ParamVec: named values. Parameters of Gazebo are nested; in ROS they are a flat list with the path in each name.

Source: ros_gz_bridge/src/convert/ros_gz_interfaces.cpp; gz/msgs/param.proto and param_v.proto
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterValue
from ros_gz_interfaces.msg import ParamVec

from gz_course.sim.bridge.ros_gz_bridge.convert.rcl_interfaces import copy_value, fill_value
from gz_course.sim.bridge.ros_gz_bridge.fields import Part, message_pair
from gz_course.sim.bridge.ros_gz_bridge.header import copy_header, fill_header
from gz_course.sim.bridge.ros_gz_bridge.remarks import remark
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import ConversionError
from gz_course.sim.gz.msgs.any_pb2 import Any as GzAny

_DEEPEST = 50  # protobuf does not parse more than 100 nested messages


def _flat(gz: Any, prefix: str = "") -> Iterator[Parameter]:
    """Yield the parameters of a `gz.msgs.Param` and of its children, in the order of their names."""
    for name in sorted(gz.params):
        parameter = Parameter(name=prefix + name)
        fill_value(gz.params[name], parameter.value)  # a type that ROS does not have leaves the value unset
        yield parameter
    for number, child in enumerate(gz.children):
        yield from _flat(child, f"{prefix}child_{number}/")


def _nest(params: Iterable[tuple[str, ParameterValue]], gz: Any, depth: int = 0) -> None:
    """Write named values into a `gz.msgs.Param`; names that begin with `child_0/` go to its first child."""
    if depth > _DEEPEST:
        raise ConversionError(f"the parameters are nested deeper than {_DEEPEST} times")
    own, children = _grouped(params, "child")
    for name, value in own:
        if not copy_value(value, gz.params[name]):
            gz.params[name].type = GzAny.NONE
            remark(f"the parameter {name} is a list; gz.msgs.Param holds single values only, so it is sent without one")
    for child in children:
        _nest(child, gz.children.add(), depth + 1)


def _grouped(
    params: Iterable[tuple[str, ParameterValue]], word: str
) -> tuple[list[tuple[str, ParameterValue]], list[list[tuple[str, ParameterValue]]]]:
    """Return the values without a prefix `word_<number>/`, and those with one, without it, by number."""
    plain: list[tuple[str, ParameterValue]] = []
    groups: dict[int, list[tuple[str, ParameterValue]]] = {}
    for name, value in params:
        if match := re.fullmatch(rf"{word}_([0-9]{{1,9}})/(.*)", name, re.DOTALL):
            groups.setdefault(int(match[1]), []).append((match[2], value))
        else:
            plain.append((name, value))
    return plain, [groups[number] for number in sorted(groups)]


def _named(ros: ParamVec) -> Iterator[tuple[str, ParameterValue]]:
    return ((param.name, param.value) for param in ros.params)


def _fill_one(gz: Any, ros: ParamVec) -> None:
    fill_header(gz.header, ros.header)
    ros.params = list(_flat(gz))


def _copy_one(ros: ParamVec, gz: Any) -> None:
    copy_header(ros.header, gz.header)
    _nest(_named(ros), gz)


def _fill_several(gz: Any, ros: ParamVec) -> None:
    """Write several sets of parameters, named `param_0/name` and so on."""
    fill_header(gz.header, ros.header)
    ros.params = [param for number, one in enumerate(gz.param) for param in _flat(one, f"param_{number}/")]


def _copy_several(ros: ParamVec, gz: Any) -> None:
    """Write several sets of parameters; names without `param_<number>/` form the first set."""
    copy_header(ros.header, gz.header)
    plain, sets = _grouped(_named(ros), "param")
    for params in [*([plain] if plain else []), *sets]:
        _nest(params, gz.param.add())


message_pair("ros_gz_interfaces/msg/ParamVec", "gz.msgs.Param", Part(ParamVec, _fill_one, _copy_one))
message_pair("ros_gz_interfaces/msg/ParamVec", "gz.msgs.Param_V", Part(ParamVec, _fill_several, _copy_several))
