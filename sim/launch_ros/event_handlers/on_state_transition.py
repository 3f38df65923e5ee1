"""The event handler that waits for a lifecycle node to change its state."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.event_handler import EventHandler, known_entities
from gz_course.sim.launch_ros.events.lifecycle import StateTransition


class OnStateTransition(EventHandler):
    """A handler of a lifecycle node's change of state, which does not happen here."""

    def __init__(self, *, entities: Any, target_lifecycle_node: Any = None, **arguments: Any) -> None:
        super().__init__(
            matcher=lambda event: isinstance(event, StateTransition),
            entities=known_entities(entities, "entities of OnStateTransition"),
        )
        self.target_lifecycle_node = target_lifecycle_node
        self.arguments = arguments
