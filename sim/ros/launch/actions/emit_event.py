"""The action that emits an event."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity


class EmitEvent(Action):
    """Emits `event` when it is executed."""

    def __init__(self, *, event: Event, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not isinstance(event, Event):
            is_entity = isinstance(event, LaunchDescriptionEntity)
            hint = "; launch.events.Shutdown() is one, launch.actions.Shutdown() is not" if is_entity else ""
            raise TypeError(f"event={event!r} of EmitEvent is of type {type(event).__name__}, not an event{hint}")
        self.event = event

    def describe(self) -> str:
        return f"Emitting event '{self.event.name}'"

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        context.emit_event_sync(self.event)
        return None
