"""Load parameter file for a node."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import yaml

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.message_value import parse_yaml
from gz_course.sim.ros.ros2.parameter import add_node_options, flat, node_parameters, parameter_value
from gz_course.sim.ros.ros2.topic import warn

_EVERY_NODE = "/**"
_KEY = "ros__parameters"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_node_options(parser)
    parser.add_argument("parameter_file", help="Parameter file in YAML format")
    parser.add_argument("--no-use-wildcard", action="store_true", help="Do not load parameters in the '/**' namespace")
    parser.add_argument("--strict", action="store_true", help="Exit code 1 if the node refuses a value (default: 0)")


def main(arguments: argparse.Namespace) -> int:
    """Set the parameters of the file for this node, one by one; report refusals on stderr."""
    content = _read(Path(arguments.parameter_file))
    with node_parameters(arguments) as parameters:
        found = _for_node(content, parameters.node, arguments)
        values = {name: parameter_value(value, f"{name}: {value}") for name, value in found.items()}
        refused = 0
        for name, value in values.items():
            taken, reason = parameters.set(name, value)
            if taken:
                print(f"Set parameter {name} successful{reason}")
            else:
                warn(f"Set parameter {name} failed{reason}")
                refused = 1
    return refused if arguments.strict else 0


def _read(path: Path) -> dict[str, Any]:
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not text in UTF-8"
        raise CommandError(f"{path} cannot be read: {reason}") from None
    try:
        parse_yaml(text)
        content = yaml.safe_load(text)
    except (CommandError, ValueError) as error:
        raise CommandError(f"{path}: {str(error).removeprefix('The passed value ')}") from None
    if not isinstance(content, dict) or not content:
        raise CommandError(f"{path} is no parameter file: it must begin with a node's name or {_EVERY_NODE}")
    return {str(name): value for name, value in content.items()}


def _for_node(content: dict[str, Any], node: str, arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the parameters for a node by flat name; the node's own entry takes precedence over that for every node."""
    found: dict[str, Any] = {}
    applies = [node, node.lstrip("/"), arguments.node_name]
    keys = ([] if arguments.no_use_wildcard else [_EVERY_NODE]) + list(dict.fromkeys(applies))
    path = arguments.parameter_file
    for key in keys:
        if key not in content:
            continue
        entry = content[key]
        if not isinstance(entry, dict) or not isinstance(entry.get(_KEY), dict):
            raise CommandError(f"{path}: below '{key}' there must be '{_KEY}:' and below that the parameters")
        found |= flat(entry[_KEY])
    if not any(key in content for key in keys):
        there = ", ".join(f"'{name}'" for name in content)
        raise CommandError(
            f"Param file does not contain parameters for {node}, only for nodes: {there}{did_you_mean(node, content)}"
        )
    return found
