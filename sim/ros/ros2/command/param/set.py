"""Set parameter."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.parameter import add_node_options, node_parameters, value_from_yaml
from gz_course.sim.ros.ros2.topic import warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_node_options(parser)
    parser.add_argument("parameter_name", help="Name of the parameter")
    parser.add_argument("value", help="Value of the parameter in YAML format")
    parser.add_argument("--strict", action="store_true", help="Exit code 1 if the node refuses the value (default: 0)")


def main(arguments: argparse.Namespace) -> int:
    value = value_from_yaml(arguments.value)
    with node_parameters(arguments) as parameters:
        taken, reason = parameters.set(arguments.parameter_name, value)
    if taken:
        print(f"Set parameter successful{reason}")
        return 0
    warn(f"Setting parameter failed{reason}")
    return 1 if arguments.strict else 0
