"""The action that runs a coroutine in parallel to the launch."""

from __future__ import annotations

import asyncio
import inspect
from collections.abc import Awaitable, Callable, Iterable, Mapping
from typing import Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.event_handlers import OnShutdown
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity


class OpaqueCoroutine(Action):
    """Runs `coroutine(context, *args, **kwargs)`. The launch waits for it; a shutdown cancels it."""

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
        self.__future: asyncio.Task[None] | None = None

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        return self.__future

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        if context.asyncio_loop is None:
            raise LaunchError("OpaqueCoroutine can only be executed by a LaunchService that runs")
        arguments = self.__args if self.__ignore_context else [context, *self.__args]

        def cancel(event: Event, context: LaunchContext) -> None:
            task.cancel()

        with context.uninterrupted():
            task = context.asyncio_loop.create_task(self._run(arguments))
            self.__future = task
            context.register_event_handler(OnShutdown(on_shutdown=cancel))
        return None

    async def _run(self, arguments: Iterable[Any]) -> None:
        await self.__coroutine(*arguments, **self.__kwargs)
