"""Events of lifecycle nodes. They can be written in a launch file; lifecycle nodes are not executed here."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from gz_course.sim.launch.event import Event


class ChangeState(Event):
    """Asks the lifecycle nodes that `lifecycle_node_matcher(action)` accepts for a transition."""

    name = "launch_ros.events.lifecycle.ChangeState"

    def __init__(self, *, lifecycle_node_matcher: Callable[[Any], bool], transition_id: int) -> None:
        self.lifecycle_node_matcher = lifecycle_node_matcher
        self.transition_id = transition_id


class StateTransition(Event):
    """Tells that the lifecycle node of `action` has changed its state, as `msg` says."""

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: Any, msg: Any) -> None:
        self.action = action
        self.msg = msg


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Return a matcher for actions of nodes with this full name."""
    wanted = node_name if node_name.startswith("/") else f"/{node_name}"
    return lambda action: getattr(action, "node_name", None) == wanted
