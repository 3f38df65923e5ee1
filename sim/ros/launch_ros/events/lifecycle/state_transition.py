"""The event for a state transition of a lifecycle node."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.event import Event


class StateTransition(Event):
    """The state transition `msg`, a lifecycle_msgs/msg/TransitionEvent, of the lifecycle node of `action`."""

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: Any, msg: Any) -> None:
        self.action = action
        self.msg = msg

    @property
    def timestamp(self) -> int:
        return int(self.msg.timestamp)

    @property
    def transition(self) -> str:
        return str(self.msg.transition.label)

    @property
    def start_state(self) -> str:
        return str(self.msg.start_state.label)

    @property
    def goal_state(self) -> str:
        return str(self.msg.goal_state.label)
