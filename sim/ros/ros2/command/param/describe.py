"""Show descriptive information about declared parameters."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from typing import Any

from gz_course.sim.ros.ros2.parameter import add_node_options, node_parameters, type_word


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_node_options(parser)
    parser.add_argument("parameter_names", nargs="+", help="Names of the parameters")


def main(arguments: argparse.Namespace) -> None:
    with node_parameters(arguments) as parameters:
        for descriptor in parameters.descriptors(arguments.parameter_names):
            print("\n".join(_lines(descriptor)))


def _lines(descriptor: Any) -> Iterator[str]:
    yield f"Parameter name: {descriptor.name}"
    yield f"  Type: {type_word(descriptor.type)}"
    if descriptor.description:
        yield f"  Description: {descriptor.description}"
    yield "  Constraints:"
    if descriptor.read_only:
        yield "    Read only: true"
    for limits in (*descriptor.floating_point_range, *descriptor.integer_range):
        yield f"    Min value: {limits.from_value}"
        yield f"    Max value: {limits.to_value}"
        if limits.step:
            yield f"    Step: {limits.step}"
    if descriptor.additional_constraints:
        yield f"    Additional constraints: {descriptor.additional_constraints}"
