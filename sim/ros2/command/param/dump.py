"""Show all of the parameters of a node in a YAML file format."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import yaml

from gz_course.sim.ros2.errors import CommandError
from gz_course.sim.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros2.node import find_node
from gz_course.sim.ros2.parameter import NodeParameters, nested, python_value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The node, and where to."""
    add_graph_options(parser)
    parser.add_argument("node_name", help="Name of the ROS node")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Accepted: a node is named anyway")
    parser.add_argument("--output-dir", metavar="DIR", help="Write to a file named after the node in this folder")
    parser.add_argument("--print", action="store_true", help="Accepted and ignored: it prints anyway")


def main(arguments: argparse.Namespace) -> None:
    """Everything the node has, as `ros2 param load` and `--params-file` take it."""
    with Graph(arguments) as graph:
        node = find_node(graph, arguments.node_name, "Node not found")
        parameters = NodeParameters(graph, node)
        names = parameters.names()
        values = dict(zip(names, map(python_value, parameters.values(names)), strict=True)) if names else {}
    found: dict[str, Any] = {name: value for name, value in values.items() if value is not None}
    text = yaml.safe_dump({node: {"ros__parameters": nested(found)}}, default_flow_style=False, allow_unicode=True)
    if arguments.output_dir is None:
        print(text)
        return
    path = Path(arguments.output_dir) / f"{node.strip('/').replace('/', '__')}.yaml"
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise CommandError(f"{path} cannot be written: {error.strerror}") from None
    print(f"Saving to:  {path}")
