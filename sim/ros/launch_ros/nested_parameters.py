"""Parameters of nodes in launch files in XML and YAML:

    <param name="speed" value="0.5"/>
    <param name="wheel"> <param name="radius" value="0.1" type="float"/> </param>
    <param from="$(dirname)/robot.yaml" allow_substs="true"/>

Text has the type it has in YAML, unless `type` says another (`bool`, `int`, `float`, `str`, with `[]` a list of them);
`value-sep` makes a list of it.

Source: ros2/launch_ros, launch_ros/launch_ros/actions/node.py (parse_nested_parameters)
"""

from __future__ import annotations

from collections.abc import Iterable
from types import GenericAlias
from typing import TYPE_CHECKING, Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.frontend.entity import Entity, EntityError
from gz_course.sim.ros.launch_ros.parameter_descriptions import ParameterFile, ParameterValue

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Parser

_TYPES: dict[str, Any] = {"bool": bool, "int": int, "float": float, "double": float, "str": str, "string": str}
_TYPES |= {f"{name}[]": GenericAlias(list, (kind,)) for name, kind in _TYPES.items()}
Pairs = list[tuple[list[Any], list[Any]]]


def parse_node_options(entity: Entity, parser: Parser) -> dict[str, Any]:
    """Read `<param>` and `<remap>` of a node as its options `parameters` and `remappings`, if there are any."""
    options: dict[str, Any] = {}
    remappings = entity.get_attr("remap", data_type=list[Entity], optional=True)
    if remappings is not None:
        options["remappings"] = parse_remappings(remappings, parser)
    parameters = entity.get_attr("param", data_type=list[Entity], optional=True)
    if parameters is not None:
        options["parameters"] = parse_nested_parameters(parameters, parser)
    return options


def parse_nested_parameters(parameters: Iterable[Entity], parser: Parser) -> list[Any]:
    """Return the elements as the `parameters` of Node."""
    result: list[Any] = []
    for each in parameters:
        file = each.get_attr("from", optional=True)
        if file is None:
            name, value = _named(each, parser)
            if result and isinstance(result[-1], dict):
                result[-1][name] = value
            else:
                result.append({name: value})
        else:
            if each.get_attr("name", optional=True) is not None:
                raise EntityError(each, f"{each.described()} has both 'name' and 'from'; they exclude each other")
            substituted = each.get_attr("allow_substs", data_type=bool, optional=True)
            path = parser.parse_substitution(file)
            result.append(ParameterFile(path, allow_substs=parser.parse_if_substitutions(substituted or False)))
        each.assert_entity_completely_parsed()
    return result


def _named(entity: Entity, parser: Parser) -> tuple[tuple[Any, ...], Any]:
    """Return the name and the value of an element; the value is a dict if it holds others."""
    name = tuple(parser.parse_substitution(entity.get_attr("name")))
    word = entity.get_attr("type", optional=True)
    kind = None
    if word is not None:
        if word not in _TYPES:
            raise EntityError(
                entity, f"there is no type '{word}'{did_you_mean(word, _TYPES, listing='there are')}", "type"
            )
        kind = _TYPES[word]
    nested = entity.get_attr("param", data_type=list[Entity], optional=True)
    value = entity.get_attr("value", data_type=kind, optional=True)
    if nested is not None:
        if value is not None:
            raise EntityError(entity, f"{entity.described()} has both a value and other parameters in it")
        pairs = [_named(each, parser) for each in nested]
        for each in nested:
            each.assert_entity_completely_parsed()
        return name, dict(pairs)
    if value is None:
        raise EntityError(entity, f"{entity.described()} lacks the attribute 'value'")
    return name, ParameterValue(parser.parse_if_substitutions(value), value_type=kind)


def parse_remappings(remappings: Iterable[Entity], parser: Parser) -> Pairs:
    """Return elements with `from` and `to` as the `remappings` of Node."""
    pairs = []
    for each in remappings:
        pairs.append((parser.parse_substitution(each.get_attr("from")), parser.parse_substitution(each.get_attr("to"))))
        each.assert_entity_completely_parsed()
    return pairs
