"""The state of a running launch: configurations, environment, event handlers, pending events.

`LaunchService` creates it and passes it to every visited entity. `GroupAction` pushes and pops scopes of
configurations, environment and locals.
"""

from __future__ import annotations

import asyncio
import collections
import contextlib
import itertools
import os
from collections.abc import Iterable, Iterator, MutableMapping
from types import SimpleNamespace
from typing import Any

from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.event_handler import EventHandler
from gz_course.sim.ros.launch.substitution import Substitution


class LaunchContext:
    """The state of a launch; `argv` are the command-line arguments for launch files that read them."""

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False) -> None:
        self.argv = list(argv or ())
        self.noninteractive = noninteractive
        self.__handlers: collections.deque[EventHandler] = collections.deque()
        self.__events: collections.deque[Event] = collections.deque()
        self.__futures: set[asyncio.Future[None]] = set()
        self.__failures: list[BaseException] = []
        self.__wake: asyncio.Event | None = None
        self.__loop: asyncio.AbstractEventLoop | None = None
        self.__globals: dict[str, Any] = {}
        self.__locals: list[dict[str, Any]] = [{}]
        self.__configurations: list[dict[str, Any]] = [{}]
        self.__first_environment = dict(os.environ)
        self.__environments: list[dict[str, str]] = []
        self.__is_shutdown = False
        self.__is_uninterrupted = False
        self._held_signal: int | None = None
        self.process_numbers = itertools.count(1)

    @property
    def is_shutdown(self) -> bool:
        """True once the launch has begun to shut down; no process is started any more."""
        return self.__is_shutdown

    def _set_is_shutdown(self, state: bool) -> None:
        self.__is_shutdown = state

    def _hold_signal(self, number: int) -> None:
        """Record a signal that arrives during a visit.

        Raises KeyboardInterrupt, because the visit may never return; once the launch is shutting down, only for the
        second signal, because every handler must hear of the shutdown.
        """
        is_first = self._held_signal is None
        self._held_signal = number
        if not (self.__is_uninterrupted or (self.is_shutdown and is_first)):
            raise KeyboardInterrupt

    @contextlib.contextmanager
    def uninterrupted(self) -> Iterator[None]:
        """Postpone the KeyboardInterrupt of a signal to the end of the block, for the start of a process or task."""
        self.__is_uninterrupted = True
        try:
            yield
        finally:
            self.__is_uninterrupted = False
        if self._held_signal is not None:
            raise KeyboardInterrupt

    # Configurations, environment, locals, globals

    @property
    def launch_configurations(self) -> dict[str, Any]:
        """Return the launch configurations of this scope by name."""
        return self.__configurations[-1]

    def _push_launch_configurations(self) -> None:
        self.__configurations.append(dict(self.launch_configurations))

    def _pop_launch_configurations(self) -> None:
        if len(self.__configurations) == 1:
            raise LaunchError("PopLaunchConfigurations without a PushLaunchConfigurations before it")
        self.__configurations.pop()

    @property
    def environment(self) -> MutableMapping[str, str]:
        """Return the environment of this process, which children inherit."""
        return os.environ

    def _push_environment(self) -> None:
        self.__environments.append(dict(os.environ))

    def _pop_environment(self) -> None:
        if not self.__environments:
            raise LaunchError("PopEnvironment without a PushEnvironment before it")
        self._replace_environment(self.__environments.pop())

    def _reset_environment(self) -> None:
        self._replace_environment(self.__first_environment)

    def _replace_environment(self, environment: dict[str, str]) -> None:
        for name in set(os.environ) - set(environment):
            del os.environ[name]
        for name, value in environment.items():
            if os.environ.get(name) != value:
                os.environ[name] = value

    @property
    def locals(self) -> SimpleNamespace:
        """Return the local values of this scope, such as `event` and the path of the current launch file."""
        return SimpleNamespace(**self.get_locals_as_dict())

    def get_locals_as_dict(self) -> dict[str, Any]:
        return {**self.__globals, **self.__locals[-1]}

    def extend_locals(self, extensions: dict[str, Any]) -> None:
        self.__locals[-1].update(extensions)

    def extend_globals(self, extensions: dict[str, Any]) -> None:
        self.__globals.update(extensions)

    def _push_locals(self) -> None:
        self.__locals.append(dict(self.__locals[-1]))

    def _pop_locals(self) -> None:
        if len(self.__locals) == 1:
            raise LaunchError("there are no locals to pop")
        self.__locals.pop()

    def _drop_scopes(self) -> None:
        """Pop all scopes that an error has left open."""
        del self.__locals[1:], self.__configurations[1:]
        self.__environments.clear()

    def perform_substitution(self, substitution: Substitution) -> str:
        """Return the text of a substitution. Raises LaunchError if `perform` returns no text."""
        text = substitution.perform(self)
        if not isinstance(text, str):
            raise LaunchError(
                f"{type(substitution).__name__}.perform() returned {text!r} of type {type(text).__name__}, not text"
            )
        return text

    # Events

    @property
    def asyncio_loop(self) -> asyncio.AbstractEventLoop | None:
        """Return the event loop of the launch, None before its start."""
        return self.__loop

    def _set_asyncio_loop(self, loop: asyncio.AbstractEventLoop | None) -> None:
        self.__loop = loop
        self.__wake = asyncio.Event() if loop is not None else None
        if self.__wake is not None:
            self.__wake.set()

    def register_event_handler(self, event_handler: EventHandler, append: bool = False) -> None:
        """Add a handler in front of the others, or with `append` behind them."""
        if append:
            self.__handlers.append(event_handler)
        else:
            self.__handlers.appendleft(event_handler)

    def unregister_event_handler(self, event_handler: EventHandler) -> None:
        """Remove a handler. Raises ValueError if it is not registered."""
        self.__handlers.remove(event_handler)

    def would_handle_event(self, event: Event) -> bool:
        """Return whether a handler matches, or its matcher fails, which is reported when the event is handled."""
        try:
            return any(handler.matches(event) for handler in self.__handlers)
        except Exception:
            return True

    def handlers_of(self, event: Event) -> list[EventHandler]:
        """Return the handlers of this event, newest first."""
        return [handler for handler in self.__handlers if handler.matches(event)]

    async def emit_event(self, event: Event) -> None:
        self.emit_event_sync(event)

    def emit_event_sync(self, event: Event) -> None:
        """Queue an event; thread-safe."""
        self.__events.append(event)
        self._wake_up()

    def _next_event(self) -> Event | None:
        return self.__events.popleft() if self.__events else None

    # Completion

    def add_completion_future(self, future: asyncio.Future[None]) -> None:
        """Keep the launch running until the future is done; an exception in it ends the launch."""
        if future in self.__futures or (future.done() and (future.cancelled() or future.exception() is None)):
            return
        self.__futures.add(future)
        future.add_done_callback(self._completed)

    def _completed(self, future: asyncio.Future[None]) -> None:
        self.__futures.discard(future)
        if not future.cancelled():
            error = future.exception()
            if error is not None:
                self.__failures.append(error)
        self._wake_up()

    @property
    def _is_busy(self) -> bool:
        return bool(self.__futures)

    def _next_failure(self) -> BaseException | None:
        return self.__failures.pop(0) if self.__failures else None

    def _wake_up(self) -> None:
        loop, wake = self.__loop, self.__wake
        if loop is not None and wake is not None and not loop.is_closed():
            loop.call_soon_threadsafe(wake.set)

    async def _something_happens(self) -> None:
        assert self.__wake is not None
        await self.__wake.wait()
        self.__wake.clear()
