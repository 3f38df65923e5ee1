"""The decorator of fixtures that are launches, and the launch behind one."""

from __future__ import annotations

import functools
import inspect
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import pytest

from gz_course.sim.ros.launch.launch_description import LaunchDescription
from gz_course.sim.ros.launch.launch_service import LaunchService
from gz_course.sim.ros.launch_testing.actions.ready import ReadyToTest
from gz_course.sim.ros.launch_testing.loader import ready_actions


class Launch:
    """A launch that runs in a thread of its own, from `start` to `shutdown`."""

    def __init__(self, description: LaunchDescription, shutdown_when_idle: bool, auto_shutdown: bool) -> None:
        self.service = LaunchService()
        self._auto_shutdown = auto_shutdown
        self._begun = threading.Event()
        self._code: int | None = None
        found = list(ready_actions(description.entities))
        if len(found) > 1:
            raise RuntimeError("launch_pytest fixtures must return a LaunchDescription with only one ReadyToTest")
        if not found:
            found = [ReadyToTest()]
            description.add_action(found[0])
        found[0]._add_callback(self._begun.set)
        self.service.include_launch_description(description)
        self._thread = threading.Thread(target=self._run, args=[shutdown_when_idle], name="launch_pytest")

    def start(self) -> None:
        """Start the thread, and wait for ReadyToTest. Raises RuntimeError if the launch fails before."""
        self._thread.start()
        self._begun.wait()
        if self._code:
            raise RuntimeError("the launch failed before ReadyToTest; its last line says why")

    def shutdown(self) -> None:
        """End the launch, or wait for it if it ends by itself. Raises RuntimeError if it has failed."""
        if self._auto_shutdown:
            self.service.shutdown()
        self._thread.join()
        if self._code:
            raise RuntimeError(f"the launch ended with exit code {self._code}; its last line says why")

    def _run(self, shutdown_when_idle: bool) -> None:
        try:
            self._code = self.service.run(shutdown_when_idle=shutdown_when_idle)
        except BaseException:
            self._code = 1
            raise
        finally:
            self._begun.set()


class Place:
    """Where the launch of a fixture is found while it runs."""

    def __init__(self, scope: Any) -> None:
        self.scope = scope
        self.launch: Launch | None = None


def fixture(
    decorated: Callable[..., Any] | None = None,
    *args: Any,
    shutdown_when_idle: bool = True,
    auto_shutdown: bool = True,
    **kwargs: Any,
) -> Any:
    """Make a fixture of a function that returns a launch description, or a sequence that begins with one.

    The launch runs as long as the fixture is needed. It ends earlier when all processes have ended, unless
    `shutdown_when_idle` is False; without `auto_shutdown` it ends only by itself. The rest is as of `pytest.fixture`.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        place = Place(kwargs.get("scope", "function"))

        @functools.wraps(function)
        def launched(*given: Any, **named: Any) -> Iterator[Any]:
            generator = function(*given, **named) if inspect.isgeneratorfunction(function) else None
            result = next(generator) if generator is not None else function(*given, **named)
            description = result[0] if isinstance(result, Sequence) and result else result
            if not isinstance(description, LaunchDescription):
                raise TypeError(
                    f"the launch_pytest fixture '{function.__name__}' must return a launch description, or a sequence "
                    f"which first item is one, not {result!r}"
                )
            place.launch = Launch(description, shutdown_when_idle, auto_shutdown)
            place.launch.start()
            try:
                yield result
            finally:
                place.launch.shutdown()
                if generator is not None:
                    next(generator, None)

        launched.launch_place = place  # type: ignore[attr-defined]
        return pytest.fixture(launched, *args, **kwargs)

    return decorate if decorated is None else decorate(decorated)
