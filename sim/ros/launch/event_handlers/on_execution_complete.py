"""The event handler for the completion of an action."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.event_handlers.on_action_event_base import OnActionEventBase, Reaction, TargetAction
from gz_course.sim.ros.launch.events import ExecutionComplete


class OnExecutionComplete(OnActionEventBase):
    """Handles the completion of an action with `on_completion`."""

    def __init__(self, *, target_action: TargetAction = None, on_completion: Reaction, **kwargs: Any) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_completion,
            target_event_cls=ExecutionComplete,
            argument="on_completion",
            **kwargs,
        )
