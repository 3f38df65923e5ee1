"""The event that requests a transition of a lifecycle node."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch_ros.lifecycle_states import STATES, TRANSITIONS, transition_number


class ChangeState(Event):
    """Requests a transition of the lifecycle nodes that `lifecycle_node_matcher(action)` accepts.

    `transition_id` is a constant of lifecycle_msgs/msg/Transition.
    """

    name = "launch_ros.events.lifecycle.ChangeState"
    valid_states: ClassVar[dict[int, str]] = STATES
    valid_transitions: ClassVar[dict[int, str]] = TRANSITIONS

    def __init__(self, *, lifecycle_node_matcher: Callable[[Any], bool], transition_id: int) -> None:
        self.lifecycle_node_matcher = lifecycle_node_matcher
        self.transition_id = transition_number(transition_id)
