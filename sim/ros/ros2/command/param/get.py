"""Get parameter."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.parameter import add_node_options, kind_word, node_parameters, python_value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_node_options(parser)
    parser.add_argument("parameter_name", help="Name of the parameter")
    parser.add_argument("--hide-type", action="store_true", help="Hide the type information")


def main(arguments: argparse.Namespace) -> None:
    with node_parameters(arguments) as parameters:
        value = parameters.values([arguments.parameter_name])[0]
        shown = python_value(value)
        if shown is None:
            raise parameters.not_set(arguments.parameter_name)
    print(shown if arguments.hide_type else f"{kind_word(value)} {shown}")
