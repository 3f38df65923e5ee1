"""Waits for the start, the output or the end of a process; each function also as a coroutine function.

`validate_output(text)` returns whether the output is what is wanted, or raises AssertionError if it is not (yet); the
process needs `cached_output=True`. `timeout` [s] is the longest wait, None for ever.
"""

from __future__ import annotations

import asyncio
import contextlib
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

from gz_course.sim.ros.launch.actions.execute_local import ExecuteLocal
from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.event_handler import EventHandler
from gz_course.sim.ros.launch.events.process import ProcessExited, ProcessIO, ProcessStarted
from gz_course.sim.ros.launch.launch_context import LaunchContext

Validate = Callable[[str], Any]
_LOOK_S = 0.2  # [s] until it is seen that the launch has ended


def wait_for_output_sync(
    launch_context: LaunchContext, action: ExecuteLocal, validate_output: Validate, timeout: float | None = None
) -> Any:
    """Wait until stdout is as wanted; return what `validate_output` returns, or raise its AssertionError."""
    return _wait(launch_context, action, lambda: validate_output(action.get_stdout()), timeout)


def wait_for_stderr_sync(
    launch_context: LaunchContext, action: ExecuteLocal, validate_output: Validate, timeout: float | None = None
) -> Any:
    """Wait until stderr is as wanted; return what `validate_output` returns, or raise its AssertionError."""
    return _wait(launch_context, action, lambda: validate_output(action.get_stderr()), timeout)


def wait_for_start_sync(launch_context: LaunchContext, action: ExecuteLocal, timeout: float | None = None) -> bool:
    """Wait for the start of a process; return whether it has started."""
    return bool(_wait(launch_context, action, lambda: action.process_details is not None, timeout))


def wait_for_exit_sync(launch_context: LaunchContext, action: ExecuteLocal, timeout: float | None = None) -> bool:
    """Wait for the end of a process; return whether it has ended."""
    return bool(_wait(launch_context, action, lambda: action.return_code is not None, timeout))


async def wait_for_output(
    launch_context: LaunchContext, action: ExecuteLocal, validate_output: Validate, timeout: float | None = None
) -> Any:
    return await asyncio.to_thread(wait_for_output_sync, launch_context, action, validate_output, timeout)


async def wait_for_stderr(
    launch_context: LaunchContext, action: ExecuteLocal, validate_output: Validate, timeout: float | None = None
) -> Any:
    return await asyncio.to_thread(wait_for_stderr_sync, launch_context, action, validate_output, timeout)


async def wait_for_start(launch_context: LaunchContext, action: ExecuteLocal, timeout: float | None = None) -> bool:
    return await asyncio.to_thread(wait_for_start_sync, launch_context, action, timeout)


async def wait_for_exit(launch_context: LaunchContext, action: ExecuteLocal, timeout: float | None = None) -> bool:
    return await asyncio.to_thread(wait_for_exit_sync, launch_context, action, timeout)


def _wait(context: LaunchContext, action: ExecuteLocal, condition: Callable[[], Any], timeout: float | None) -> Any:
    """Look at a condition after each event of a process, and once more at the end."""
    end = float("inf") if timeout is None else time.monotonic() + timeout
    happened = threading.Event()
    with _listening(context, action, happened):
        while context.asyncio_loop is not None and (left := end - time.monotonic()) > 0:
            happened.clear()
            with contextlib.suppress(AssertionError):
                if result := condition():
                    return result
            happened.wait(min(left, _LOOK_S))
    return condition()


@contextlib.contextmanager
def _listening(context: LaunchContext, action: ExecuteLocal, happened: threading.Event) -> Iterator[None]:
    """Set an event at each event of the process; handlers come and go in the thread of the launch."""

    def accepts(event: Event) -> bool:
        if isinstance(event, ProcessStarted | ProcessIO | ProcessExited) and event.action is action:
            happened.set()
        return False

    handler = EventHandler(matcher=accepts)
    loop = context.asyncio_loop
    with contextlib.suppress(AttributeError, RuntimeError):  # the launch has ended
        loop.call_soon_threadsafe(context.register_event_handler, handler, True)  # type: ignore[union-attr]
    try:
        yield
    finally:
        with contextlib.suppress(AttributeError, RuntimeError):
            loop.call_soon_threadsafe(context.unregister_event_handler, handler)  # type: ignore[union-attr]
