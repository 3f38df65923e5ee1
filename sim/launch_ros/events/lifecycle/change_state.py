"""The event that requests a transition of a lifecycle node."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from gz_course.sim.launch.event import Event


class ChangeState(Event):
    """Requests a transition of the lifecycle nodes that `lifecycle_node_matcher(action)` accepts."""

    name = "launch_ros.events.lifecycle.ChangeState"

    def __init__(self, *, lifecycle_node_matcher: Callable[[Any], bool], transition_id: int) -> None:
        self.lifecycle_node_matcher = lifecycle_node_matcher
        self.transition_id = transition_id
