"""The event handler for state transitions of a lifecycle node."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.event_handler import EventHandler, known_entities
from gz_course.sim.ros.launch_ros.events.lifecycle import StateTransition


class OnStateTransition(EventHandler):
    """Returns `entities` for transitions of one lifecycle node, or of all (None).

    `transition`, `start_state` and `goal_state` are names, such as `configure`, `configuring` and `inactive`; those
    that are given must be those of the event. With `matcher` nothing else counts.
    """

    def __init__(
        self,
        *,
        entities: Any,
        target_lifecycle_node: Any = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        matcher: Callable[[Event], bool] | None = None,
        **kwargs: Any,
    ) -> None:
        if target_lifecycle_node is not None and not getattr(target_lifecycle_node, "is_lifecycle_node", False):
            raise RuntimeError(f"target_lifecycle_node={target_lifecycle_node!r} is no LifecycleNode")
        self.target_lifecycle_node = target_lifecycle_node
        self._wanted = {"transition": transition, "start_state": start_state, "goal_state": goal_state}
        known = known_entities(entities, "entities of OnStateTransition")
        super().__init__(matcher=matcher or self._accepts, entities=known, **kwargs)

    def _accepts(self, event: Event) -> bool:
        if not isinstance(event, StateTransition):
            return False
        if self.target_lifecycle_node is not None and event.action is not self.target_lifecycle_node:
            return False
        return all(wanted in (None, getattr(event, name)) for name, wanted in self._wanted.items())
