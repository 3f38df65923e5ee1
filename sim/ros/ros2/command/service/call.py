"""Call a service."""

from __future__ import annotations

import argparse
import sys
import time
from typing import Any

from rclpy.qos import QoSPresetProfiles

from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.interface import service_class, service_type_name
from gz_course.sim.ros.ros2.message_value import fill
from gz_course.sim.ros.ros2.option_values import rate, seconds
from gz_course.sim.ros.ros2.qos import add_qos_options, chosen_qos
from gz_course.sim.ros.ros2.service import call, nearest_service, service_name

_AVAILABLE = 10.0  # [s] to wait for the service
_ANSWER = 60.0  # [s] to wait for the response


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("service_name", help="Name of the ROS service to call to (e.g. '/add_two_ints')")
    parser.add_argument("service_type", help="Type of the ROS service (e.g. 'std_srvs/srv/Empty')")
    parser.add_argument(
        "values",
        nargs="?",
        default="{}",
        help="Values to fill the service request with in YAML format (e.g. '{a: 1, b: 2}'), otherwise default values",
    )
    parser.add_argument("--stdin", action="store_true", help="Read the values from standard input")
    parser.add_argument("-r", "--rate", type=rate, metavar="N", help="Repeat the call at a specific rate in Hz")
    parser.add_argument(
        "--timeout",
        type=seconds,
        metavar="SECONDS",
        help=f"How long to wait for the service (default: {_AVAILABLE:g}) and for its answer (default: {_ANSWER:g}); "
        "0: for ever",
    )
    add_qos_options(parser, "services_default")


def main(arguments: argparse.Namespace) -> None:
    """Call once; with --rate until interrupted."""
    kind = service_class(arguments.service_type)
    request = kind.Request()
    stamps = fill(request, sys.stdin.read() if arguments.stdin else arguments.values)
    available, answer = (_AVAILABLE, _ANSWER) if arguments.timeout is None else (arguments.timeout,) * 2
    with Graph(arguments) as graph:
        qos = chosen_qos(arguments, QoSPresetProfiles.get_from_short_key("services_default"))
        client = graph.node.create_client(kind, service_name(graph, arguments.service_name), qos_profile=qos)
        while True:
            started = time.monotonic()
            _wait_for_service(graph, client, available or None)
            now = graph.node.get_clock().now().to_msg()
            for stamp in stamps:
                stamp(now)
            print(f"requester: making request: {request!r}\n")
            response = call(graph, client, request, answer or None)
            print(f"response:\n{response!r}\n")
            if arguments.rate is None:
                return
            graph.spin_for(started + 1.0 / arguments.rate - time.monotonic())


def _wait_for_service(graph: Graph, client: Any, timeout: float | None) -> None:
    if graph.wait_for(client.service_is_ready):
        return
    print("waiting for service to become available...")
    name, own = client.srv_name, service_type_name(client.srv_type)
    others = [kind for kind in dict(graph.services(hidden=True)).get(name, []) if kind != own]
    if others:
        raise CommandError(f"The service {name} has the type {', '.join(others)}, not {own}")
    if not graph.spin_until(client.service_is_ready, timeout):
        hint = nearest_service(graph, name)
        raise CommandError(f"The service {name} is not available{hint}")
