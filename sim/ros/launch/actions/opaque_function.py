"""The action that calls a function while the launch file runs, when the values of arguments are known."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity, listed
from gz_course.sim.ros.launch.some_entities_type import SomeEntitiesType


class OpaqueFunction(Action):
    """Calls `function(context, *args, **kwargs)`, which may return actions."""

    def __init__(
        self,
        *,
        function: Callable[..., SomeEntitiesType | None],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        if not callable(function):
            raise TypeError(f"function={function!r} of OpaqueFunction cannot be called")
        self.__function = function
        self.__args = list(args or ())
        self.__kwargs = dict(kwargs or {})

    def describe(self) -> str:
        return f"OpaqueFunction({getattr(self.__function, '__name__', repr(self.__function))})"

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        result = self.__function(context, *self.__args, **self.__kwargs)
        name = getattr(self.__function, "__name__", "the function")
        return None if result is None else listed(result, f"what {name}() of OpaqueFunction returned")
