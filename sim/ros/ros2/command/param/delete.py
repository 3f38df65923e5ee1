"""Delete parameter."""

from __future__ import annotations

import argparse

from rcl_interfaces.msg import ParameterValue

from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.parameter import add_node_options, node_parameters, python_value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_node_options(parser)
    parser.add_argument("parameter_name", help="Name of the parameter")


def main(arguments: argparse.Namespace) -> None:
    name = arguments.parameter_name
    with node_parameters(arguments) as parameters:
        if python_value(parameters.values([name])[0]) is None:
            raise parameters.not_set(name)
        deleted, reason = parameters.set(name, ParameterValue())
    if not deleted:  # only parameters of dynamic type can be deleted
        raise CommandError(f"Deleting parameter failed{reason}")
    print(f"Deleted parameter successfully{reason}")
