"""The event handler that visits the launch description of an event."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.event_handler import EventHandler
from gz_course.sim.ros.launch.events.include_launch_description import IncludeLaunchDescription
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_entities_type import SomeEntitiesType


class OnIncludeLaunchDescription(EventHandler):
    """Visits what the event `launch.events.IncludeLaunchDescription` has with it; every LaunchService has one."""

    def __init__(self, **options: Any) -> None:
        super().__init__(matcher=lambda event: isinstance(event, IncludeLaunchDescription), **options)

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        return [event.launch_description] if isinstance(event, IncludeLaunchDescription) else None
