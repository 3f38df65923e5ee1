"""The event handler for the start of a process."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.actions.execute_local import ExecuteLocal
from gz_course.sim.ros.launch.event_handlers.on_action_event_base import OnActionEventBase, Reaction, TargetAction
from gz_course.sim.ros.launch.events.process import ProcessStarted


class OnProcessStart(OnActionEventBase):
    """Handles the start of a process with `on_start`."""

    def __init__(self, *, target_action: TargetAction = None, on_start: Reaction, **kwargs: Any) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_start,
            target_event_cls=ProcessStarted,
            target_action_cls=ExecuteLocal,
            argument="on_start",
            **kwargs,
        )
