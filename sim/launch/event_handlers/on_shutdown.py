"""The event handler that waits for the end of the launch."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gz_course.sim.launch.event import Event
from gz_course.sim.launch.event_handler import EventHandler, answer, known_entities
from gz_course.sim.launch.event_handlers.on_action_event_base import Reaction
from gz_course.sim.launch.events import Shutdown
from gz_course.sim.launch.launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from gz_course.sim.launch.launch_context import LaunchContext


class OnShutdown(EventHandler):
    """Answers Shutdown, with actions or with a function(event, context). No process is started any more."""

    def __init__(self, *, on_shutdown: Reaction, **kwargs: Any) -> None:
        self._reaction = on_shutdown
        super().__init__(
            matcher=lambda event: isinstance(event, Shutdown),
            entities=known_entities(on_shutdown, "on_shutdown of OnShutdown"),
            **kwargs,
        )

    def handle(self, event: Event, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the answer to the event."""
        super().handle(event, context)
        return answer(self._reaction, event, context, "on_shutdown of OnShutdown")

    @property
    def matcher_description(self) -> str:
        """Which events it waits for, for `--print`."""
        return "Shutdown"
