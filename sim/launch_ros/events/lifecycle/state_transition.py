"""The event for a state transition of a lifecycle node."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.event import Event


class StateTransition(Event):
    """The state transition `msg` of the lifecycle node of `action`."""

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: Any, msg: Any) -> None:
        self.action = action
        self.msg = msg
