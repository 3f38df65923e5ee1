"""Waits for an event and answers it with actions; the usual ones are in `launch.event_handlers`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from gz_course.sim.launch.event import Event
from gz_course.sim.launch.launch_description_entity import LaunchDescriptionEntity, listed
from gz_course.sim.launch.some_entities_type import SomeEntitiesType

if TYPE_CHECKING:
    from gz_course.sim.launch.launch_context import LaunchContext


class EventHandler:
    """Answers each event that `matcher(event)` accepts with `entities`; once only with `handle_once`."""

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        entities: SomeEntitiesType | None = None,
        handle_once: bool = False,
    ) -> None:
        self.__matcher = matcher
        self.__entities = listed(entities, f"{type(self).__name__}")
        self.__handle_once = handle_once

    @property
    def entities(self) -> list[LaunchDescriptionEntity]:
        """The answer, as far as it is known before the event."""
        return self.__entities

    @property
    def handle_once(self) -> bool:
        """Whether it stops after the first event."""
        return self.__handle_once

    @property
    def handler_description(self) -> str:
        """What the handler does, for `--print`."""
        return f"<{len(self.__entities)} actions>"

    @property
    def matcher_description(self) -> str:
        """Which events it waits for, for `--print`."""
        return getattr(self.__matcher, "__name__", repr(self.__matcher))

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return one line for `--print`, and the entities."""
        text = f"{type(self).__name__}(matcher='{self.matcher_description}', handler='{self.handler_description}')"
        return text, list(self.__entities)

    def matches(self, event: Event) -> bool:
        """Return whether this event is to be answered."""
        return bool(self.__matcher(event))

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Return the answer to the event; the handler leaves when it answers only once."""
        if self.__handle_once:
            context.unregister_event_handler(self)
        return self.__entities


def answer(reaction: Any, event: Event, context: LaunchContext, what: str) -> list[LaunchDescriptionEntity]:
    """Return the entities of a handler's `on_...` argument: an entity, several, or callable(event, context)."""
    result = reaction(event, context) if callable(reaction) else reaction
    return listed(result, what)


def known_entities(reaction: Any, what: str) -> list[LaunchDescriptionEntity]:
    """Return the entities of an `on_...` argument known beforehand: those that are not made by a function."""
    if callable(reaction):
        return []
    if not isinstance(reaction, LaunchDescriptionEntity | Iterable):
        raise TypeError(f"{what} is {reaction!r}; an action, a list of actions or a function is expected")
    return listed(reaction, what)
