"""The action that registers an event handler."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.event_handler import EventHandler
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity


class RegisterEventHandler(Action):
    """Registers an event handler in front of those already registered."""

    def __init__(self, event_handler: EventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not isinstance(event_handler, EventHandler):
            raise TypeError(
                f"RegisterEventHandler wants an event handler such as OnProcessExit(...), not {event_handler!r} of "
                f"type {type(event_handler).__name__}"
            )
        self.event_handler = event_handler

    def describe(self) -> str:
        return f"RegisterEventHandler({self.event_handler.describe()[0]})"

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        return [(f"Conditionally included by {self.describe()}", self.event_handler.entities)]

    def execute(self, context: LaunchContext) -> None:
        context.register_event_handler(self.event_handler)
