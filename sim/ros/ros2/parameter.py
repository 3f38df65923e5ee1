"""Parameters of a running node, for the verbs of `ros2 param`.

A node offers its parameters as services `<node>/list_parameters`, `get_parameters` and so on (package rcl_interfaces);
values are `rcl_interfaces/ParameterValue`. On the command line a value is YAML: `5` is an integer, `5.0` a double,
`'5'` a string, `[1, 2]` an integer array.

Source: ros2/rcl_interfaces, rcl_interfaces/msg/ParameterValue.msg
"""

from __future__ import annotations

import argparse
import contextlib
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import yaml
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.message_value import parse_yaml
from gz_course.sim.ros.ros2.node import find_node
from gz_course.sim.ros.ros2.option_values import seconds
from gz_course.sim.ros.ros2.service import ANSWER_DEADLINE, call

_FIELDS = {
    ParameterType.PARAMETER_BOOL: ("Boolean", "boolean", "bool_value"),
    ParameterType.PARAMETER_INTEGER: ("Integer", "integer", "integer_value"),
    ParameterType.PARAMETER_DOUBLE: ("Double", "double", "double_value"),
    ParameterType.PARAMETER_STRING: ("String", "string", "string_value"),
    ParameterType.PARAMETER_BYTE_ARRAY: ("Byte", "byte array", "byte_array_value"),
    ParameterType.PARAMETER_BOOL_ARRAY: ("Boolean", "boolean array", "bool_array_value"),
    ParameterType.PARAMETER_INTEGER_ARRAY: ("Integer", "integer array", "integer_array_value"),
    ParameterType.PARAMETER_DOUBLE_ARRAY: ("Double", "double array", "double_array_value"),
    ParameterType.PARAMETER_STRING_ARRAY: ("String", "string array", "string_array_value"),
}
"""For each type: the word in `get`, the word in `describe`, the field of ParameterValue."""

_EXPONENT = re.compile(r"[-+]?\d+(\.\d*)?[eE][-+]?\d+")
_INT64 = range(-(2**63), 2**63)


class NodeParameters:
    """The parameters of one node, through its services."""

    def __init__(self, graph: Graph, node: str, timeout: float | None = None) -> None:
        self.node = node
        self._graph = graph
        self._timeout = timeout

    def _call(self, kind: Any, service: str, request: Any) -> Any:
        client = self._graph.node.create_client(kind, f"{self.node}/{service}")
        if not self._graph.wait_for(client.service_is_ready, self._timeout):
            raise CommandError(f"The node {self.node} has no parameter services")
        hint = f"; the node {self.node} does not spin, is busy in a callback, or was killed: ros2 node list"
        return call(self._graph, client, request, self._timeout or ANSWER_DEADLINE, hint)

    def names(self, prefixes: Sequence[str] = ()) -> list[str]:
        """Return all parameters, or those with these prefixes, sorted."""
        response = self._call(ListParameters, "list_parameters", ListParameters.Request(prefixes=list(prefixes)))
        return sorted(response.result.names)

    def values(self, names: Sequence[str]) -> list[ParameterValue]:
        """Return the value of each parameter, PARAMETER_NOT_SET for one that does not exist."""
        found = list(self._call(GetParameters, "get_parameters", GetParameters.Request(names=list(names))).values)
        if len(found) == len(names):
            return found
        # A node returns nothing at all if one of several does not exist.
        return [ParameterValue()] if len(names) == 1 else [self.values([name])[0] for name in names]

    def descriptors(self, names: Sequence[str]) -> list[Any]:
        """Return the rcl_interfaces/ParameterDescriptor of each. Raises CommandError if one does not exist."""
        request = DescribeParameters.Request(names=list(names))
        found = list(self._call(DescribeParameters, "describe_parameters", request).descriptors)
        known = self.names()
        for name in names:
            if name not in known:
                raise self.not_set(name, known)
        return found

    def set(self, name: str, value: ParameterValue) -> tuple[bool, str]:
        """Set a parameter; return whether the node accepts it, and `: <reason>` if it gives one. PARAMETER_NOT_SET
        deletes.
        """
        if type_word(value.type).endswith(" array"):
            value = _as(self.values([name])[0].type, value)
        request = SetParameters.Request(parameters=[ParameterMessage(name=name, value=value)])
        results = self._call(SetParameters, "set_parameters", request).results
        if not results:
            return False, ": the node gave no reason"
        return results[0].successful, f": {results[0].reason}" if results[0].reason else ""

    def not_set(self, name: str, known: Iterable[str] | None = None) -> CommandError:
        """Return the error for a missing parameter, with the nearest name."""
        names = set(self.names() if known is None else known)
        # A declared parameter may have no value.
        return CommandError("Parameter not set" + ("" if name in names else did_you_mean(name, names)))


def add_node_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of every verb about the parameters of one node."""
    add_graph_options(parser)
    parser.add_argument("node_name", help="Name of the ROS node")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Accepted: a node is named anyway")
    add_timeout(parser)


def add_timeout(parser: argparse.ArgumentParser) -> None:
    """Add the option for how long a node may take to appear, and then to answer."""
    parser.add_argument(
        "--timeout",
        type=seconds,
        metavar="N",
        help="Wait for N seconds for the node and its answers (default: as needed)",
    )


@contextlib.contextmanager
def node_parameters(arguments: argparse.Namespace) -> Iterator[NodeParameters]:
    """Open the parameters of the node that the arguments name. Raises CommandError if there is no such node."""
    with Graph(arguments) as graph:
        node = find_node(graph, arguments.node_name, "Node not found", arguments.timeout)
        yield NodeParameters(graph, node, arguments.timeout)


def python_value(value: ParameterValue) -> Any:
    """Return the value as bool, int, float, str or a list of these; None if not set."""
    if value.type not in _FIELDS:
        return None
    found = getattr(value, _FIELDS[value.type][2])
    if value.type == ParameterType.PARAMETER_BYTE_ARRAY:
        return [int.from_bytes(item, "little") for item in found]
    return found if isinstance(found, bool | int | float | str) else list(found)


def _as(kind: int, value: ParameterValue) -> ParameterValue:
    """Convert a list to `kind`, the parameter's type: an empty list has none, and bytes look like integers."""
    items = python_value(value)
    if not items and type_word(kind).endswith(" array"):
        return ParameterValue(type=kind)
    if kind == ParameterType.PARAMETER_BYTE_ARRAY and all(isinstance(item, int) and 0 <= item < 256 for item in items):
        return ParameterValue(type=kind, byte_array_value=[bytes([item]) for item in items])
    return value


def kind_word(value: ParameterValue) -> str:
    """Return `Integer value is:`, `Integer values are:` and so on."""
    word = _FIELDS[value.type][0]
    return f"{word} values are:" if _FIELDS[value.type][1].endswith(" array") else f"{word} value is:"


def type_word(kind: int) -> str:
    """Return `integer`, `string array`, `not set` and so on."""
    return _FIELDS[kind][1] if kind in _FIELDS else "not set"


def value_from_yaml(text: str) -> ParameterValue:
    """Return the parameter value of a YAML text. Raises CommandError if no parameter can have this value."""
    parse_yaml(text)  # raises an error with the position
    try:
        value = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, RecursionError):
        value = text  # for example an invalid date; parameters have no dates
    if not isinstance(value, bool | int | float | str | list | dict):
        value = text.strip()  # nothing, null, a date
    if value == text.strip() and _EXPONENT.fullmatch(value):
        value = float(value)  # for YAML 1.1, 1e-3 is a text
    return parameter_value(value, text)


def parameter_value(value: Any, shown: str) -> ParameterValue:
    """Return the parameter value of a Python value; `shown` is the user's text for error messages."""
    kind, converted = _typed(value, shown)
    message = ParameterValue(type=kind)
    setattr(message, _FIELDS[kind][2], converted)
    return message


def _typed(value: Any, shown: str) -> tuple[int, Any]:
    if isinstance(value, bool):
        return ParameterType.PARAMETER_BOOL, value
    if isinstance(value, int):
        return ParameterType.PARAMETER_INTEGER, _int64(value, shown)
    if isinstance(value, float):
        return ParameterType.PARAMETER_DOUBLE, value
    if isinstance(value, str):
        return ParameterType.PARAMETER_STRING, value
    if isinstance(value, list):
        return _typed_list(value, shown)
    raise CommandError(
        f"{_short(shown)} cannot be a parameter: it must be a bool, a number, a string or a list of one kind"
    )


def _typed_list(items: list[Any], shown: str) -> tuple[int, list[Any]]:
    kinds = {type(item) for item in items}
    if kinds == {bool}:
        return ParameterType.PARAMETER_BOOL_ARRAY, items
    if kinds == {int}:
        return ParameterType.PARAMETER_INTEGER_ARRAY, [_int64(item, shown) for item in items]
    if kinds and kinds <= {int, float}:
        return ParameterType.PARAMETER_DOUBLE_ARRAY, [float(item) for item in items]
    if kinds <= {str}:  # also an empty list: the node reports the type it expects
        return ParameterType.PARAMETER_STRING_ARRAY, items
    raise CommandError(f"{_short(shown)} cannot be a parameter: the items of a list must be of one kind")


def _int64(value: int, shown: str) -> int:
    if value not in _INT64:
        raise CommandError(f"{_short(shown)} does not fit into 64 bits")
    return value


def _short(text: str) -> str:
    return repr(text if len(text) <= 60 else text[:60] + "...")


def nested(parameters: dict[str, Any]) -> dict[str, Any]:
    """Convert parameters with names like `a.b.c` to nested dictionaries, as in parameter files."""
    tree: dict[str, Any] = {}
    for name, value in sorted(parameters.items()):
        *groups, last = name.split(".")
        place = tree
        for depth, group in enumerate(groups):
            inner = place.setdefault(group, {})
            if not isinstance(inner, dict):  # `a` and `a.b` both exist: a file can contain the second one only flat
                last = ".".join([*groups[depth:], last])
                break
            place = inner
        place[last] = value
    return tree


def flat(tree: dict[Any, Any], prefix: str = "") -> dict[str, Any]:
    """Convert nested dictionaries to parameters with names like `a.b.c`."""
    found: dict[str, Any] = {}
    for name, value in tree.items():
        full = f"{prefix}{name}"
        if isinstance(value, dict):
            found |= flat(value, f"{full}.")
        else:
            found[full] = value
    return found
