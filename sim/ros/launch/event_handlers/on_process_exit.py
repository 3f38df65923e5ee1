"""The event handler for the end of a process."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.action_of_processes import ActionOfProcesses
from gz_course.sim.ros.launch.actions.execute_local import ExecuteLocal
from gz_course.sim.ros.launch.event import Event
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

    def _accepts(self, event: Event) -> bool:
        """Accept the end of the process; where an action stands for several, that of the last one."""
        if not super()._accepts(event):
            return False
        is_one = not isinstance(self._target, ActionOfProcesses)
        return is_one or self._target.ends_with(event.action)  # type: ignore[attr-defined, union-attr]
