"""Event handlers that wait for what happens to an action: its process starts, prints or ends, or it is done."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from gz_course.sim.launch.action import Action
from gz_course.sim.launch.event import Event
from gz_course.sim.launch.event_handler import EventHandler, answer, known_entities
from gz_course.sim.launch.events import ExecutionComplete
from gz_course.sim.launch.events.process import ProcessExited, ProcessIO, ProcessStarted
from gz_course.sim.launch.launch_description_entity import LaunchDescriptionEntity, SomeEntitiesType

if TYPE_CHECKING:
    from gz_course.sim.launch.launch_context import LaunchContext

TargetAction = Action | Callable[[Action], bool] | None
Reaction = SomeEntitiesType | Callable[[Any, "LaunchContext"], SomeEntitiesType | None]


class OnActionEventBase(EventHandler):
    """Base: answers events of a class, of one action, of those a function accepts, or of all (None).

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
        if not (action_matcher is None or is_function or isinstance(action_matcher, target_action_cls)):
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
        if isinstance(self._target, Action):
            return action is self._target
        return bool(self._target(action))

    def handle(self, event: Event, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the answer to the event; the handler leaves when it answers only once."""
        super().handle(event, context)
        return answer(self._reaction, event, context, self._argument)

    @property
    def handler_description(self) -> str:
        """What the handler does, for `--print`."""
        return repr(self._reaction) if callable(self._reaction) else f"<{len(self.entities)} actions>"

    @property
    def matcher_description(self) -> str:
        """Which events it waits for, for `--print`."""
        target = "any action" if self._target is None else repr(self._target)
        return f"{self._event_class.__name__} of {target}"


def _process_action() -> type[Action]:
    from gz_course.sim.launch.actions import ExecuteLocal

    return ExecuteLocal


class OnProcessExit(OnActionEventBase):
    """Answers the end of a process."""

    def __init__(
        self, *, target_action: TargetAction = None, on_exit: Reaction, handle_once: bool = False, **kwargs: Any
    ) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_exit,
            target_event_cls=ProcessExited,
            target_action_cls=_process_action(),
            handle_once=handle_once,
            argument="on_exit",
            **kwargs,
        )


class OnProcessStart(OnActionEventBase):
    """Answers the start of a process."""

    def __init__(
        self, *, target_action: TargetAction = None, on_start: Reaction, handle_once: bool = False, **kwargs: Any
    ) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_start,
            target_event_cls=ProcessStarted,
            target_action_cls=_process_action(),
            handle_once=handle_once,
            argument="on_start",
            **kwargs,
        )


class OnProcessIO(OnActionEventBase):
    """Answers what a process prints: `on_stdout(event)` and `on_stderr(event)`, with the bytes `event.text`."""

    def __init__(
        self,
        *,
        target_action: TargetAction = None,
        on_stdin: Callable[[ProcessIO], SomeEntitiesType | None] | None = None,
        on_stdout: Callable[[ProcessIO], SomeEntitiesType | None] | None = None,
        on_stderr: Callable[[ProcessIO], SomeEntitiesType | None] | None = None,
        **kwargs: Any,
    ) -> None:
        by_descriptor = dict(enumerate((on_stdin, on_stdout, on_stderr)))

        def react(event: ProcessIO, context: LaunchContext) -> SomeEntitiesType | None:
            reaction = by_descriptor[event.fd]
            return None if reaction is None else reaction(event)

        super().__init__(
            action_matcher=target_action,
            on_event=react,
            target_event_cls=ProcessIO,
            target_action_cls=_process_action(),
            **kwargs,
        )


class OnExecutionComplete(OnActionEventBase):
    """Answers that an action is done."""

    def __init__(
        self, *, target_action: TargetAction = None, on_completion: Reaction, handle_once: bool = False, **kwargs: Any
    ) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_completion,
            target_event_cls=ExecutionComplete,
            handle_once=handle_once,
            argument="on_completion",
            **kwargs,
        )
