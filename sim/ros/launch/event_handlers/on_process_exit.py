"""The event handler for the end of a process."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.actions.execute_local import ExecuteLocal
from gz_course.sim.ros.launch.event_handlers.on_action_event_base import OnActionEventBase, Reaction, TargetAction
from gz_course.sim.ros.launch.events.process import ProcessExited


class OnProcessExit(OnActionEventBase):
    """Handles the end of a process with `on_exit`."""

    def __init__(self, *, target_action: TargetAction = None, on_exit: Reaction, **kwargs: Any) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_exit,
            target_event_cls=ProcessExited,
            target_action_cls=ExecuteLocal,
            argument="on_exit",
            **kwargs,
        )
