"""The base class of actions, the elements of a launch file. The actions are in `launch.actions`."""

from __future__ import annotations

import inspect
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.condition import Condition
from gz_course.sim.ros.launch.errors import LaunchError, locate, place_of_caller
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser
    from gz_course.sim.ros.launch.launch_context import LaunchContext


class Action(LaunchDescriptionEntity):
    """An element of a launch file, executed if `condition` holds; subclasses override `execute`."""

    def __init__(self, *, condition: Condition | None = None, **unknown: Any) -> None:
        if unknown:
            name = next(iter(unknown))
            hint = did_you_mean(name, _arguments(type(self)), listing="there are")
            raise TypeError(f"{type(self).__name__} has no argument '{name}'{hint}")
        if condition is not None and not isinstance(condition, Condition):
            raise TypeError(
                f"condition={condition!r} is of type {type(condition).__name__}; "
                "IfCondition(...), UnlessCondition(...) or another condition is expected"
            )
        self.__condition = condition
        self._place = place_of_caller()

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Return the class and the arguments that an element of an XML or YAML launch file has for every action."""
        from gz_course.sim.ros.launch.conditions import IfCondition, UnlessCondition

        holds = entity.get_attr("if", optional=True)
        not_holds = entity.get_attr("unless", optional=True)
        if holds is not None and not_holds is not None:
            raise LaunchError("`if` and `unless` exclude each other")
        if holds is not None:
            return cls, {"condition": IfCondition(parser.parse_substitution(holds))}
        if not_holds is not None:
            return cls, {"condition": UnlessCondition(parser.parse_substitution(not_holds))}
        return cls, {}

    @property
    def condition(self) -> Condition | None:
        return self.__condition

    def describe(self) -> str:
        return f"{type(self).__name__}({hex(id(self))})"

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities that are visited unconditionally: none if there is a condition."""
        return self.get_sub_entities() if self.__condition is None else []

    def describe_conditional_sub_entities(
        self,
    ) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        return [("Conditionally included by " + self.describe(), self.get_sub_entities())] if self.__condition else []

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities that are visited on execution, as far as they are known in advance."""
        return []

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Execute the action if its condition holds; errors get the place where the action was created."""
        try:
            if self.__condition is not None and not self.__condition.evaluate(context):
                return None
            following = self.execute(context)
        except Exception as error:
            locate(error, self._place)
            raise
        self._announce_completion(context)
        return following

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Return the entities to be visited next."""
        raise NotImplementedError(f"{type(self).__name__} does not say how it is executed")

    def _announce_completion(self, context: LaunchContext) -> None:
        """Emit ExecutionComplete if it has a handler now; emit it at once, or when the action's future is done.

        Source: ros2/launch, launch/launch/action.py
        """
        from gz_course.sim.ros.launch.events import ExecutionComplete

        event = ExecutionComplete(action=self)
        if not context.would_handle_event(event):
            return
        future = self.get_asyncio_future()
        if future is None or future.done():
            context.emit_event_sync(event)
        else:
            future.add_done_callback(lambda _: context.emit_event_sync(event))


def _arguments(kind: type) -> list[str]:
    """Return the names of all keyword arguments of a class and its bases."""
    return [
        parameter.name
        for each in kind.__mro__
        if "__init__" in vars(each) and each is not object
        for parameter in inspect.signature(vars(each)["__init__"]).parameters.values()
        if parameter.name != "self" and parameter.kind not in (parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL)
    ]
