"""The event handler for state transitions of a lifecycle node."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.event_handler import EventHandler, known_entities
from gz_course.sim.launch_ros.events.lifecycle import StateTransition


class OnStateTransition(EventHandler):
    """Handles state transitions of a lifecycle node, which do not occur here."""

    def __init__(self, *, entities: Any, target_lifecycle_node: Any = None, **arguments: Any) -> None:
        super().__init__(
            matcher=lambda event: isinstance(event, StateTransition),
            entities=known_entities(entities, "entities of OnStateTransition"),
        )
        self.target_lifecycle_node = target_lifecycle_node
        self.arguments = arguments
