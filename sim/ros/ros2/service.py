"""Service names and calls for the verbs of `ros2 service` and `ros2 param`."""

from __future__ import annotations

from typing import Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph
from gz_course.sim.ros.ros2.topic import full_name

ANSWER_DEADLINE = 5.0  # [s] for services of parameters, which answer from memory


def service_name(graph: Graph, name: str) -> str:
    """Return the name with its namespace. Raises CommandError for an invalid name."""
    return full_name(graph, name, "service")


def service_types(graph: Graph, name: str) -> list[str]:
    """Return the types of a service as soon as it is found; empty if it is not."""
    return graph.wait_for(lambda: dict(graph.services(hidden=True)).get(name, []))


def nearest_service(graph: Graph, name: str) -> str:
    """Return `; did you mean '/x'?` for the nearest service of the graph, or an empty text."""
    offered = (service for service, _ in graph.services(hidden=True) if graph.node.count_services(service))
    return did_you_mean(name, (service for service in offered if service != name))


def call(graph: Graph, client: Any, request: Any, timeout: float | None, hint: str = "") -> Any:
    """Call an available service; return the response.

    Raises CommandError if the service disappears or does not answer within `timeout` [s]; `hint` is appended to the
    latter sentence.
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
