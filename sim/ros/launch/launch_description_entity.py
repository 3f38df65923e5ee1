"""The base class of actions and launch descriptions, which can be visited and may return further entities.

`visit` visits an entity and its descendants depth first; `LaunchService` calls it for each event.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, ClassVar

from gz_course.sim.ros.launch.errors import LaunchError

if TYPE_CHECKING:
    from asyncio import Future

    from gz_course.sim.ros.launch.launch_context import LaunchContext


class LaunchDescriptionEntity:
    """An action or a launch description.

    The class variables tell whoever looks for the arguments of a launch description what an entity is.
    """

    declares_argument: ClassVar[bool] = False
    includes_description: ClassVar[bool] = False
    hides_arguments: ClassVar[bool] = False  # those from outside, from the entities that follow

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Return the entities to be visited next."""
        return None

    def describe(self) -> str:
        return repr(self)

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities that follow unconditionally, as far as they are known before the visit."""
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the entities that may follow, each group with its condition in words."""
        return []

    def get_asyncio_future(self) -> Future[None] | None:
        """Return a future that is done when the entity is; None if it is done after the visit."""
        return None


def listed(entities: Any, what: str) -> list[LaunchDescriptionEntity]:
    """Return one entity, an iterable of them or None as a list.

    Raises LaunchError for anything else; `what` names its origin in the error.
    """
    if entities is None:
        return []
    if isinstance(entities, LaunchDescriptionEntity):
        return [entities]
    items = list(entities) if isinstance(entities, Iterable) else [entities]
    for item in items:
        if not isinstance(item, LaunchDescriptionEntity):
            raise LaunchError(f"{what} holds {item!r} of type {type(item).__name__}; only actions can stand there")
    return items


def visit(entity: LaunchDescriptionEntity, context: LaunchContext) -> None:
    """Visit an entity and its descendants, depth first; add their futures to the context."""
    if not isinstance(entity, LaunchDescriptionEntity):
        raise LaunchError(f"{entity!r} of type {type(entity).__name__} stands where an action is expected")
    following = entity.visit(context)
    future = entity.get_asyncio_future()
    if future is not None:
        context.add_completion_future(future)
    for each in following or ():
        visit(each, context)
