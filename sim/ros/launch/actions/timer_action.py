"""The action that visits other actions after a delay."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.event_handler import EventHandler
from gz_course.sim.ros.launch.events import Shutdown, TimerEvent
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity, listed
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser


@expose_action("timer")
class TimerAction(Action):
    """Visits `actions` once, `period` [s] after its execution; the end of the launch cancels it.

    They see the launch configurations (namespace, parameters, remappings, arguments) of the moment of its execution,
    and what they change ends with them. The environment is that of the later moment.
    Source: ros2/launch, release 3.4.5 (pull request 836)
    """

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[LaunchDescriptionEntity],
        cancel_on_shutdown: bool | SomeSubstitutionsType = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.period = normalize_to_list_of_substitutions(str(period) if isinstance(period, int | float) else period)
        self.actions = listed(actions, "the list of TimerAction")
        self.__cancel_on_shutdown = normalize_to_list_of_substitutions(
            str(cancel_on_shutdown) if isinstance(cancel_on_shutdown, bool) else cancel_on_shutdown
        )
        self.__future: asyncio.Future[None] | None = None
        self.__cancel_timer: Callable[[], None] | None = None
        self.__canceled = False
        self.__scope: tuple[dict[str, Any], dict[str, Any]] = ({}, {})

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<timer period= [cancel_on_shutdown=]>`, which holds actions."""
        _, options = super().parse(entity, parser)
        period = entity.get_attr("period", data_type=float)
        options["period"] = parser.parse_if_substitutions(period)
        options["actions"] = [parser.parse_action(child) for child in entity.children]
        cancel = entity.get_attr("cancel_on_shutdown", data_type=bool, optional=True)
        if cancel is not None:
            options["cancel_on_shutdown"] = parser.parse_if_substitutions(cancel)
        return cls, options

    def describe(self) -> str:
        return f"{type(self).__name__}(period={' + '.join(part.describe() for part in self.period)})"

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        return [(f"After {self.describe()}", self.actions)]

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        return self.__future

    def cancel(self) -> None:
        """Cancel the timer, also before its execution."""
        self.__canceled = True
        self._settle()

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Start the timer. Raises LaunchError for a period that is no number of seconds."""
        from gz_course.sim.ros.launch.conditions import evaluate_condition_expression

        text = perform_substitutions(context, self.period)
        try:
            period = float(text)
        except ValueError:
            period = math.nan
        if math.isnan(period):
            raise LaunchError(f"period={text!r} of {type(self).__name__} is no number of seconds")
        loop = context.asyncio_loop
        if loop is None:
            raise LaunchError(f"{type(self).__name__} can only be executed by a LaunchService that runs")
        if self.__canceled or context.is_shutdown:
            return None
        self._settle()
        self.__scope = (dict(context.launch_configurations), context.get_locals_as_dict())
        self.__future = loop.create_future()
        cancel_on_shutdown = evaluate_condition_expression(context, self.__cancel_on_shutdown)
        handler = _TimerHandler(self, cancel_on_shutdown)
        context.register_event_handler(handler)
        self.__future.add_done_callback(lambda _: context.unregister_event_handler(handler))
        due = TimerEvent(timer_action=self)
        if period < math.inf:  # an endless period ends with the launch, and one below 0 at once
            self.__cancel_timer = self._call_later(context, max(period, 0.0), lambda: context.emit_event_sync(due))
        return None

    def _call_later(self, context: LaunchContext, period: float, call: Callable[[], None]) -> Callable[[], None]:
        """Call a function after `period` [s]; return one that prevents it."""
        assert context.asyncio_loop is not None
        return context.asyncio_loop.call_later(period, call).cancel

    def _due(self) -> list[LaunchDescriptionEntity]:
        """Return the actions between the two ends of their scope."""
        return [_BeginScope(*self.__scope), *self.actions, _EndScope()]

    def _settle(self) -> None:
        if self.__cancel_timer is not None:
            self.__cancel_timer()
            self.__cancel_timer = None
        if self.__future is not None and not self.__future.done():
            self.__future.set_result(None)


class _TimerHandler(EventHandler):
    """Visits the actions at the timer's event, and cancels the timer at the end of the launch."""

    def __init__(self, timer: TimerAction, cancel_on_shutdown: bool) -> None:
        super().__init__(matcher=self._concerns_the_timer)
        self._timer = timer
        self._cancel_on_shutdown = cancel_on_shutdown

    def _concerns_the_timer(self, event: Event) -> bool:
        if isinstance(event, Shutdown):
            return self._cancel_on_shutdown
        return isinstance(event, TimerEvent) and event.timer_action is self._timer

    def handle(self, event: Event, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        future = self._timer.get_asyncio_future()
        if future is None or future.done():
            return []
        self._timer._settle()
        return self._timer._due() if isinstance(event, TimerEvent) else []


class _BeginScope(Action):
    """Begins a scope with the given launch configurations and locals, and with no other configurations."""

    def __init__(self, configurations: dict[str, Any], local_values: dict[str, Any]) -> None:
        super().__init__()
        self._configurations, self._locals = configurations, local_values

    def execute(self, context: LaunchContext) -> None:
        context._push_launch_configurations()
        context.launch_configurations.clear()
        context.launch_configurations.update(self._configurations)
        context._push_locals()
        context.extend_locals(self._locals)


class _EndScope(Action):
    """Ends the scope of `_BeginScope`."""

    def execute(self, context: LaunchContext) -> None:
        context._pop_locals()
        context._pop_launch_configurations()
