"""The plug-in of pytest: tests marked `launch` run beside the launch of their fixture, or after its end.

Every run of pytest loads this file, so it imports little. A marked function may be a coroutine function; one that
yields continues after the end of the launch. With `shutdown=True` a function runs after it.
"""

from __future__ import annotations

import asyncio
import functools
import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from gz_course.sim.ros.launch_pytest.launch_fixture import Place

_AFTER = "[shutdown_test]"  # the end of the name of the second part of a test
_Item = pytest.Item | pytest.Collector


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "launch: mark a test that runs beside the launch of `fixture=...`")


@pytest.fixture
def launch_service(request: pytest.FixtureRequest) -> Any:
    """Return the LaunchService of the test's launch."""
    mark = request.node.get_closest_marker("launch")
    if mark is None:
        raise pytest.UsageError("launch_service, launch_context and event_loop are for tests marked `launch`")
    request.getfixturevalue(mark.kwargs["fixture"].__name__)
    launch = mark.kwargs["fixture"].launch_place.launch
    return launch.service


@pytest.fixture
def launch_context(launch_service: Any) -> Any:
    """Return the context of the test's launch, for `launch_pytest.tools`."""
    return launch_service.context


@pytest.fixture
def event_loop(launch_service: Any) -> Any:
    """Return the event loop in which the test's launch runs."""
    return launch_service.event_loop


@pytest.hookimpl(tryfirst=True)
def pytest_pycollect_makeitem(collector: Any, name: str, obj: Any) -> list[_Item] | None:
    if not collector.funcnamefilter(name) or not inspect.isroutine(obj):
        return None
    mark = next((mark for mark in getattr(obj, "pytestmark", ()) if mark.name == "launch"), None)
    if mark is None:
        return None
    place = getattr(mark.kwargs.get("fixture"), "launch_place", None)
    if place is None:
        raise collector.CollectError(
            f"{name}: `pytest.mark.launch(fixture=...)` needs a function decorated by `launch_pytest.fixture`"
        )
    shutdown = mark.kwargs.get("shutdown", False)
    yields = inspect.isgeneratorfunction(obj) or inspect.isasyncgenfunction(obj)
    if yields and shutdown:
        raise collector.CollectError(f"{name}: a test that yields cannot be marked with shutdown=True")
    pytest.mark.usefixtures(mark.kwargs["fixture"].__name__)(obj)
    first, second = _parts(obj, place) if yields else (_whole(obj, place, shutdown), None)
    if second is not None and place.scope == "function":
        first, second = _both(first, second), None
    items = _items(collector, name, first, after=shutdown)
    return items if second is None else [*items, *_items(collector, name + _AFTER, second, after=True)]


def _items(collector: Any, name: str, function: Callable[..., Any], after: bool) -> list[Any]:
    setattr(collector.obj, name, function)  # where pytest finds it when it is run
    items = list(collector._genfunctions(name, function))
    for item in items:
        item.launch_is_over = after
    return items


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[Any]) -> None:
    """Move tests for after the end behind those that run beside the same launch."""
    for item in [each for each in reversed(items) if getattr(each, "launch_is_over", False)]:
        place = _place(item)
        if place is None or place.scope == "function":
            continue
        last = max((number for number, each in enumerate(items) if _is_beside(each, place)), default=-1)
        if last > items.index(item):
            items.remove(item)
            items.insert(last, item)


def _place(item: Any) -> Place | None:
    mark = item.get_closest_marker("launch")
    return None if mark is None else getattr(mark.kwargs.get("fixture"), "launch_place", None)


def _is_beside(item: Any, place: Place) -> bool:
    return not getattr(item, "launch_is_over", True) and _place(item) is place


def _whole(function: Callable[..., Any], place: Place, after: bool) -> Callable[..., Any]:
    """Return a test that runs beside the launch, or ends it first."""

    @functools.wraps(function)
    def run(*args: Any, **kwargs: Any) -> None:
        if after and place.launch is not None:
            place.launch.shutdown()
        result = function(*args, **kwargs)
        if inspect.iscoroutine(result):
            _await(result, place)

    return run


def _parts(function: Callable[..., Any], place: Place) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Return what runs up to the `yield` of a test, and the rest, which ends the launch first."""
    waiting: list[Any] = []

    @functools.wraps(function)
    def first(*args: Any, **kwargs: Any) -> None:
        test = function(*args, **kwargs)
        waiting.append(test)
        _advance(test, place)

    def second() -> None:
        if place.launch is not None:
            place.launch.shutdown()
        try:
            _advance(waiting.pop(0), place)
        except (StopIteration, StopAsyncIteration):
            return
        pytest.fail("launch_pytest generator or coroutine must stop iteration after yielding once", pytrace=False)

    second.pytestmark = list(function.pytestmark)  # type: ignore[attr-defined]
    return first, second


def _both(first: Callable[..., Any], second: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(first)
    def run(*args: Any, **kwargs: Any) -> None:
        first(*args, **kwargs)
        second()

    return run


def _advance(test: Any, place: Place) -> None:
    if inspect.isasyncgen(test):
        _await(test.__anext__(), place)
    else:
        next(test)


def _await(awaitable: Any, place: Place) -> Any:
    """Wait for a coroutine in the event loop of the launch, or in one of its own if that has ended."""

    async def wait() -> Any:
        return await awaitable

    loop = place.launch.service.event_loop if place.launch is not None else None
    if loop is None:
        return asyncio.run(wait())
    return asyncio.run_coroutine_threadsafe(wait(), loop).result()
