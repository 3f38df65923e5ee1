"""The action that unregisters an event handler."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.event_handler import EventHandler
from gz_course.sim.ros.launch.launch_context import LaunchContext


class UnregisterEventHandler(Action):
    """Unregisters an event handler. Raises LaunchError if it is not registered."""

    def __init__(self, event_handler: EventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        try:
            context.unregister_event_handler(self.event_handler)
        except ValueError:
            raise LaunchError("the event handler that is to be unregistered is not registered") from None
