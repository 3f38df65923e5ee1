"""Lifecycle nodes of the graph and their states, for the verbs of `ros2 lifecycle`.

A lifecycle node offers the services `<node>/get_state`, `change_state`, `get_available_transitions` and
`get_transition_graph` (package lifecycle_msgs).

Source: ros2/ros2cli, ros2lifecycle/ros2lifecycle/verb
"""

from __future__ import annotations

from typing import Any

from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph, is_hidden
from gz_course.sim.ros.ros2.node import find_node
from gz_course.sim.ros.ros2.service import ANSWER_DEADLINE, call

_GET_STATE = "/get_state"
_TYPE = "lifecycle_msgs/srv/GetState"


def lifecycle_nodes(graph: Graph, hidden: bool = False) -> list[str]:
    """Return the full names of the lifecycle nodes, sorted."""
    services = graph.services(hidden=True)
    names = sorted(name.removesuffix(_GET_STATE) for name, types in services if _is_state(name, types))
    return [name for name in names if hidden or not is_hidden(name)]


def _is_state(name: str, types: list[str]) -> bool:
    return name.endswith(_GET_STATE) and _TYPE in types


class Lifecycle:
    """The lifecycle of one node, through its services. Raises CommandError if there is no such lifecycle node."""

    def __init__(self, graph: Graph, node: str) -> None:
        self._graph = graph
        self.node = find_node(graph, node, "Node not found")
        if not graph.wait_for(lambda: self.node in lifecycle_nodes(graph, hidden=True)):
            known = did_you_mean(self.node, lifecycle_nodes(graph, hidden=True), listing="these are")
            raise CommandError(f"The node {self.node} is no lifecycle node{known}")

    def _call(self, kind: Any, service: str, request: Any) -> Any:
        client = self._graph.node.create_client(kind, f"{self.node}/{service}")
        if not self._graph.wait_for(client.service_is_ready):
            raise CommandError(f"The node {self.node} does not offer {self.node}/{service}")
        hint = f"; the node {self.node} does not spin, or is busy in a callback"
        return call(self._graph, client, request, ANSWER_DEADLINE, hint)

    def state(self) -> str:
        """Return the state as `label [id]`."""
        state = self._call(GetState, "get_state", GetState.Request()).current_state
        return f"{state.label} [{state.id}]"

    def transitions(self, every: bool = False) -> list[Any]:
        """Return the transitions that are possible now, or `every` one there is."""
        service = "get_transition_graph" if every else "get_available_transitions"
        answer = self._call(GetAvailableTransitions, service, GetAvailableTransitions.Request())
        return list(answer.available_transitions)

    def change(self, wanted: str) -> bool:
        """Make a transition, given by label or number; return whether it succeeded. Raises CommandError if unknown."""
        known = [each.transition for each in self.transitions()]
        found = [each for each in known if wanted in (each.label, str(each.id))]
        if not found:
            lines = [f"- {each.label} [{each.id}]" for each in known]
            raise CommandError("\n".join(["Unknown transition requested, available ones are:", *lines]))
        return bool(self._call(ChangeState, "change_state", ChangeState.Request(transition=found[0])).success)
