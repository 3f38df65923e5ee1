"""Output a list of running containers and components."""

from __future__ import annotations

import argparse

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.component import LIST_SERVICE
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.interface import service_class
from gz_course.sim.ros.ros2.service import ANSWER_DEADLINE, call

_TYPE = "composition_interfaces/srv/ListNodes"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument(
        "container_node_name", nargs="?", help="Name of the container node to list components from (default: all)"
    )
    parser.add_argument("--containers-only", action="store_true", help="List found containers nodes only")


def main(arguments: argparse.Namespace) -> None:
    """Print containers, which can only be those of a full installation beside this one, and what is in them."""
    wanted = arguments.container_node_name
    with Graph(arguments) as graph:
        graph.settle()
        names = [name for name, _ in graph.services(hidden=True) if name.endswith(LIST_SERVICE)]
        containers = [name.removesuffix(LIST_SERVICE) for name in names]
        if wanted is not None and wanted not in containers:
            raise CommandError(f"Unable to find container node '{wanted}'{did_you_mean(wanted, containers)}")
        for container in containers if wanted is None else [wanted]:
            if wanted is None:
                print(container)
            if not arguments.containers_only:
                indent = "  " if wanted is None else ""
                for line in _components(graph, container):
                    print(f"{indent}{line}")


def _components(graph: Graph, container: str) -> list[str]:
    kind = service_class(_TYPE)
    client = graph.node.create_client(kind, f"{container}{LIST_SERVICE}")
    if not graph.wait_for(client.service_is_ready):
        return []
    response = call(graph, client, kind.Request(), ANSWER_DEADLINE)
    return [f"{number}  {name}" for number, name in zip(response.unique_ids, response.full_node_names, strict=False)]
