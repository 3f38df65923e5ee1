"""The event handler for the end of the launch."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.event_handler import EventHandler, answer, known_entities
from gz_course.sim.ros.launch.event_handlers.on_action_event_base import Reaction
from gz_course.sim.ros.launch.events import Shutdown
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.launch_context import LaunchContext

_ARGUMENT = "on_shutdown of OnShutdown"


class OnShutdown(EventHandler):
    """Handles Shutdown with actions or a function(event, context); no further process is started."""

    def __init__(self, *, on_shutdown: Reaction, **kwargs: Any) -> None:
        self._reaction = on_shutdown
        super().__init__(
            matcher=lambda event: isinstance(event, Shutdown),
            entities=known_entities(on_shutdown, _ARGUMENT),
            **kwargs,
        )

    def handle(self, event: Event, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        super().handle(event, context)
        return answer(self._reaction, event, context, _ARGUMENT)

    @property
    def matcher_description(self) -> str:
        return "Shutdown"
