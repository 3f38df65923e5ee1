"""The base class of event handlers for events of actions."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.action_of_processes import ActionOfProcesses
from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.event_handler import EventHandler, answer, known_entities
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity
from gz_course.sim.ros.launch.some_entities_type import SomeEntitiesType

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.launch_context import LaunchContext

TargetAction = Action | Callable[[Action], bool] | None
Reaction = SomeEntitiesType | Callable[[Any, "LaunchContext"], SomeEntitiesType | None]


class OnActionEventBase(EventHandler):
    """Handles events of one class: those of one action, of actions that a function accepts, or of all (None).

    `on_event` is an action, a list of actions, or a function(event, context) that may return them.
    """

    def __init__(
        self,
        *,
        action_matcher: TargetAction,
        on_event: Reaction,
        target_event_cls: type[Event],
        target_action_cls: type[Action] = Action,
        handle_once: bool = False,
        argument: str = "on_event",
    ) -> None:
        is_function = callable(action_matcher) and not isinstance(action_matcher, Action)
        if not (
            action_matcher is None or is_function or isinstance(action_matcher, target_action_cls | ActionOfProcesses)
        ):
            raise TypeError(
                f"target_action={action_matcher!r} is of type {type(action_matcher).__name__}; "
                f"{target_action_cls.__name__}, a function or None is expected"
            )
        self._target = action_matcher
        self._event_class = target_event_cls
        self._reaction = on_event
        self._argument = f"{argument} of {type(self).__name__}"
        super().__init__(
            matcher=self._accepts, entities=known_entities(on_event, self._argument), handle_once=handle_once
        )

    def _accepts(self, event: Event) -> bool:
        if not isinstance(event, self._event_class):
            return False
        action = event.action  # type: ignore[attr-defined]
        if self._target is None:
            return True
        if isinstance(self._target, ActionOfProcesses):
            return any(action is each for each in self._target.processes)
        if isinstance(self._target, Action):
            return action is self._target
        return bool(self._target(action))

    def handle(self, event: Event, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        super().handle(event, context)
        return answer(self._reaction, event, context, self._argument)

    @property
    def handler_description(self) -> str:
        return repr(self._reaction) if callable(self._reaction) else f"<{len(self.entities)} actions>"

    @property
    def matcher_description(self) -> str:
        target = "any action" if self._target is None else repr(self._target)
        return f"{self._event_class.__name__} of {target}"
