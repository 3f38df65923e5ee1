"""The event that a lifecycle node has changed its state."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.event import Event


class StateTransition(Event):
    """The event that the lifecycle node of `action` has changed its state, as `msg` says."""

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: Any, msg: Any) -> None:
        self.action = action
        self.msg = msg
