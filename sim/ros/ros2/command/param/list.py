"""Output a list of available parameters."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable

from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.node import find_node
from gz_course.sim.ros.ros2.parameter import NodeParameters, add_timeout, type_word
from gz_course.sim.ros.ros2.topic import warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("node_name", nargs="?", help="Name of the ROS node (default: all nodes)")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")
    parser.add_argument(
        "--param-prefixes", nargs="+", default=[], metavar="PREFIX", help="Only list parameters with the prefixes"
    )
    parser.add_argument("--param-type", action="store_true", help="Print parameter types with parameter names")
    add_timeout(parser)
    parser.add_argument("--filter", metavar="REGEX", help="Only list parameters matching the regular expression")


def main(arguments: argparse.Namespace) -> None:
    try:
        matches = re.compile(arguments.filter or "").search
    except re.error as error:
        raise CommandError(f"--filter '{arguments.filter}' is not a regular expression: {error}") from None
    with Graph(arguments) as graph:
        if arguments.node_name:
            node = find_node(graph, arguments.node_name, "Node not found", arguments.timeout)
            _print(NodeParameters(graph, node, arguments.timeout), arguments, matches)
            return
        graph.settle()
        services = dict(graph.services(hidden=True))
        for node in sorted(set(graph.nodes(arguments.include_hidden_nodes))):
            if f"{node}/list_parameters" not in services:
                continue
            try:
                _print(NodeParameters(graph, node, arguments.timeout), arguments, matches, title=True)
            except CommandError as error:
                warn(str(error))


def _print(
    parameters: NodeParameters, arguments: argparse.Namespace, matches: Callable[[str], object], title: bool = False
) -> None:
    names = [name for name in parameters.names(arguments.param_prefixes) if matches(name)]
    types = [parameter.type for parameter in parameters.descriptors(names)] if arguments.param_type and names else []
    if title:
        print(f"{parameters.node}:")
    for index, name in enumerate(names):
        print(f"  {name} (type: {type_word(types[index])})" if types else f"  {name}")
