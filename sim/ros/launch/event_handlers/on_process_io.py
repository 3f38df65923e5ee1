"""The event handler for the output of a process."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.actions.execute_local import ExecuteLocal
from gz_course.sim.ros.launch.event_handlers.on_action_event_base import OnActionEventBase, TargetAction
from gz_course.sim.ros.launch.events.process import ProcessIO
from gz_course.sim.ros.launch.some_entities_type import SomeEntitiesType

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.launch_context import LaunchContext

OnIO = Callable[[ProcessIO], SomeEntitiesType | None]


class OnProcessIO(OnActionEventBase):
    """Handles output of a process with `on_stdout(event)` and `on_stderr(event)`; `event.text` holds the bytes."""

    def __init__(
        self,
        *,
        target_action: TargetAction = None,
        on_stdin: OnIO | None = None,
        on_stdout: OnIO | None = None,
        on_stderr: OnIO | None = None,
        **kwargs: Any,
    ) -> None:
        by_descriptor = (on_stdin, on_stdout, on_stderr)

        def react(event: ProcessIO, context: LaunchContext) -> SomeEntitiesType | None:
            reaction = by_descriptor[event.fd]
            return None if reaction is None else reaction(event)

        super().__init__(
            action_matcher=target_action,
            on_event=react,
            target_event_cls=ProcessIO,
            target_action_cls=ExecuteLocal,
            **kwargs,
        )
