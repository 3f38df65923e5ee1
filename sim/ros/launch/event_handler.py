"""The base class of event handlers. The handlers are in `launch.event_handlers`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity, listed
from gz_course.sim.ros.launch.some_entities_type import SomeEntitiesType

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.launch_context import LaunchContext


class EventHandler:
    """Returns `entities` for each event that `matcher(event)` accepts; with `handle_once` only for the first."""

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        entities: SomeEntitiesType | None = None,
        handle_once: bool = False,
    ) -> None:
        self.__matcher = matcher
        self.entities = listed(entities, f"{type(self).__name__}")
        self.handle_once = handle_once

    @property
    def handler_description(self) -> str:
        return f"<{len(self.entities)} actions>"

    @property
    def matcher_description(self) -> str:
        return getattr(self.__matcher, "__name__", repr(self.__matcher))

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        text = f"{type(self).__name__}(matcher='{self.matcher_description}', handler='{self.handler_description}')"
        return text, list(self.entities)

    def matches(self, event: Event) -> bool:
        return bool(self.__matcher(event))

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Return the entities for an event; a handler with `handle_once` unregisters itself."""
        if self.handle_once:
            context.unregister_event_handler(self)
        return self.entities


def answer(reaction: Any, event: Event, context: LaunchContext, what: str) -> list[LaunchDescriptionEntity]:
    """Return the entities of a handler's `on_...` argument: an entity, several, or callable(event, context)."""
    result = reaction(event, context) if callable(reaction) else reaction
    return listed(result, what)


def known_entities(reaction: Any, what: str) -> list[LaunchDescriptionEntity]:
    """Return the entities of an `on_...` argument that are known in advance, not returned by a function."""
    if callable(reaction):
        return []
    if not isinstance(reaction, LaunchDescriptionEntity | Iterable):
        raise TypeError(f"{what} is {reaction!r}; an action, a list of actions or a function is expected")
    return listed(reaction, what)
