"""Actions on events: emit one, end the launch, register and unregister handlers."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import gz_course.sim.launch.events as launch_events
import gz_course.sim.launch.logging as launch_logging
from gz_course.sim.launch.action import Action
from gz_course.sim.launch.errors import LaunchError
from gz_course.sim.launch.event import Event
from gz_course.sim.launch.event_handler import EventHandler
from gz_course.sim.launch.events.process import ProcessExited
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.launch_description_entity import LaunchDescriptionEntity


class EmitEvent(Action):
    """Emits an event."""

    def __init__(self, *, event: Event, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not isinstance(event, Event):
            hint = "; launch.events.Shutdown() is one, launch.actions.Shutdown() is not" if _is_action(event) else ""
            raise TypeError(f"event={event!r} of EmitEvent is of type {type(event).__name__}, not an event{hint}")
        self.__event = event

    @property
    def event(self) -> Event:
        """The event."""
        return self.__event

    def describe(self) -> str:
        """Return one line for `ros2 launch --print`."""
        return f"Emitting event '{self.__event.name}'"

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Emit it."""
        context.emit_event_sync(self.__event)
        return None


def _is_action(value: object) -> bool:
    return isinstance(value, LaunchDescriptionEntity)


class Shutdown(EmitEvent):
    """Ends the launch. As `on_exit` of a process it says that this process was required."""

    def __init__(self, *, reason: str = "reason not given", **kwargs: Any) -> None:
        super().__init__(event=launch_events.Shutdown(reason=reason), **kwargs)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Emit launch.events.Shutdown."""
        event = context.get_locals_as_dict().get("event")
        if isinstance(event, ProcessExited):
            launch_logging.get_logger("launch").info(
                f"process[{event.process_name}] was required: shutting down launched system"
            )
        return super().execute(context)


class RegisterEventHandler(Action):
    """Registers an event handler; it is asked before those that are registered already."""

    def __init__(self, event_handler: EventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not isinstance(event_handler, EventHandler):
            raise TypeError(
                f"RegisterEventHandler wants an event handler such as OnProcessExit(...), not {event_handler!r} of "
                f"type {type(event_handler).__name__}"
            )
        self.__event_handler = event_handler

    @property
    def event_handler(self) -> EventHandler:
        """The event handler."""
        return self.__event_handler

    def describe(self) -> str:
        """Return one line for `ros2 launch --print`."""
        return f"RegisterEventHandler({self.__event_handler.describe()[0]})"

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """What the handler may lead to."""
        return [(f"Conditionally included by {self.describe()}", self.__event_handler.entities)]

    def execute(self, context: LaunchContext) -> None:
        """Register it."""
        context.register_event_handler(self.__event_handler)


class UnregisterEventHandler(Action):
    """Takes an event handler away. Raises LaunchError if it is not registered."""

    def __init__(self, event_handler: EventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__event_handler = event_handler

    @property
    def event_handler(self) -> EventHandler:
        """The event handler."""
        return self.__event_handler

    def execute(self, context: LaunchContext) -> None:
        """Unregister it."""
        try:
            context.unregister_event_handler(self.__event_handler)
        except ValueError:
            raise LaunchError("the event handler that is to be unregistered is not registered") from None
