"""The patches of rclpy 7.1 that concern coroutines: one that awaits a future is resumed when the future is done.

rclpy resumes it over and over until then, so that its process would never be at rest. `rclpy_7_1_waits.py` calls
`watch_coroutines`.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from functools import partial
from typing import Any


def watch_coroutines() -> None:
    """Patch futures and the tasks of executors."""
    from rclpy.task import Future, Task

    call, executing = Task.__call__, Task.executing
    running = threading.local()  # `task` is the task that this thread executes

    def noted_call(task: Any) -> None:
        before = getattr(running, "task", None)
        running.task = task
        try:
            call(task)
        finally:
            running.task = before

    def noted_await(future: Any) -> Iterator[None]:
        while future._pending():
            task = getattr(running, "task", None)
            if task is not None:
                task.course_awaited = future
                future.add_done_callback(partial(_wake, task))
            yield
        return future.result()

    def busy(task: Any) -> bool:
        awaited = getattr(task, "course_awaited", None)
        return executing(task) or (awaited is not None and awaited._pending())

    Task.__call__, Task.executing, Future.__await__ = noted_call, busy, noted_await


def _wake(task: Any, _: Any) -> None:
    executor = task._executor()
    if executor is not None:
        executor.wake()
