"""What the verbs of `ros2 service` have in common: names, and waiting for an answer."""

from __future__ import annotations

from typing import Any

from rclpy.exceptions import InvalidServiceNameException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.validate_full_topic_name import validate_full_topic_name

from gz_course.sim.ros2.errors import CommandError, did_you_mean
from gz_course.sim.ros2.graph import Graph

ANSWER_DEADLINE = 5.0  # s for services that answer from memory, those of parameters


def service_name(graph: Graph, name: str) -> str:
    """The name with its namespace; CommandError for one ROS does not allow."""
    try:
        expanded = expand_topic_name(name, graph.node.get_name(), graph.node.get_namespace())
        validate_full_topic_name(expanded, is_service=True)
    except (InvalidServiceNameException, ValueError) as error:
        reason = str(error).partition(", at ")[0].splitlines()[0]
        raise CommandError(f"'{name}' is not a service name: {reason}") from None
    return expanded


def service_types(graph: Graph, name: str) -> list[str]:
    """The types of a service as soon as it is there; empty if it does not come."""
    return graph.wait_for(lambda: dict(graph.services(hidden=True)).get(name, []))


def nearest_service(graph: Graph, name: str) -> str:
    """`; did you mean '/x'?` for the nearest service of the graph, or nothing."""
    offered = (service for service, _ in graph.services(hidden=True) if graph.node.count_services(service))
    return did_you_mean(name, (service for service in offered if service != name))


def call(graph: Graph, client: Any, request: Any, timeout: float | None, hint: str = "") -> Any:
    """The response of a service that is there; CommandError if it goes away or is silent for `timeout` seconds.

    `timeout` None: only if it goes away. `hint` ends the sentence about a silent service.
    """
    future = client.call_async(request)
    gone = False

    def decided() -> bool:
        nonlocal gone
        gone = not future.done() and not client.service_is_ready()
        return future.done() or gone

    answered = graph.spin_until(decided, timeout)
    if not answered:
        raise CommandError(f"The service {client.srv_name} has not answered within {timeout:g} s{hint}")
    if gone:
        raise CommandError(f"The service {client.srv_name} has gone without an answer")
    return future.result()
