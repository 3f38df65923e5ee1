"""Calls a function of the launch file while it runs, when values of arguments are known."""

from __future__ import annotations

import asyncio
import inspect
from collections.abc import Awaitable, Callable, Iterable, Mapping
from typing import Any

from gz_course.sim.launch.action import Action
from gz_course.sim.launch.errors import LaunchError
from gz_course.sim.launch.event_handlers import OnShutdown
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.launch_description_entity import LaunchDescriptionEntity, SomeEntitiesType, listed


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
        """Return one line for `ros2 launch --print`."""
        return f"OpaqueFunction({getattr(self.__function, '__name__', repr(self.__function))})"

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Call it; return the actions it returned."""
        result = self.__function(context, *self.__args, **self.__kwargs)
        name = getattr(self.__function, "__name__", "the function")
        return None if result is None else listed(result, f"what {name}() of OpaqueFunction returned")


class OpaqueCoroutine(Action):
    """Runs `coroutine(context, *args, **kwargs)` beside the launch, which waits for it; a shutdown cancels it."""

    def __init__(
        self,
        *,
        coroutine: Callable[..., Awaitable[None]],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        ignore_context: bool = False,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        if not inspect.iscoroutinefunction(coroutine):
            raise TypeError(f"coroutine={coroutine!r} of OpaqueCoroutine must be defined with `async def`")
        self.__coroutine = coroutine
        self.__args = list(args or ())
        self.__kwargs = dict(kwargs or {})
        self.__ignore_context = ignore_context
        self.__future: asyncio.Future[None] | None = None

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Return what is done when the coroutine is."""
        return self.__future

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Start it."""
        loop = context.asyncio_loop
        if loop is None:
            raise LaunchError("OpaqueCoroutine can only be executed by a LaunchService that runs")
        arguments = self.__args if self.__ignore_context else [context, *self.__args]
        task = loop.create_task(_finish(self.__coroutine(*arguments, **self.__kwargs)))
        self.__future = task
        context.register_event_handler(OnShutdown(on_shutdown=lambda event, context: _cancel(task)))
        return None


async def _finish(work: Awaitable[None]) -> None:
    await work


def _cancel(task: asyncio.Task[None]) -> None:
    task.cancel()
