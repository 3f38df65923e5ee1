"""Show all of the parameters of a node in a YAML file format."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import yaml

from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.parameter import add_node_options, nested, node_parameters, python_value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_node_options(parser)
    parser.add_argument("--output-dir", metavar="DIR", help="Write to a file named after the node in this folder")
    parser.add_argument("--print", action="store_true", help="Accepted and ignored: it prints anyway")


def main(arguments: argparse.Namespace) -> None:
    """Print or write all parameters, as `ros2 param load` and `--params-file` take them."""
    with node_parameters(arguments) as parameters:
        node = parameters.node
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
