"""Runs an executor in a thread of a test, while the test creates and destroys endpoints in its own thread."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator
from typing import Any

DEADLINE = 120.0  # [s] in which a shut down executor has to end


@contextlib.contextmanager
def spinning(executor: Any) -> Iterator[threading.Thread]:
    """Yield the thread, which spins until the block ends; the executor is shut down before its nodes are destroyed."""
    closing = threading.Event()
    thread = threading.Thread(target=_spin, args=(executor, closing))
    thread.start()
    try:
        yield thread
    finally:
        closing.set()
        executor.shutdown()
        thread.join(DEADLINE)
        assert not thread.is_alive()


def _spin(executor: Any, closing: threading.Event) -> None:
    from rclpy.impl.implementation_singleton import rclpy_implementation

    while not closing.is_set():
        # An endpoint may be destroyed while the executor collects the entities to wait for.
        try:
            executor.spin()
        except rclpy_implementation.InvalidHandle:
            pass
        except AttributeError:
            if not closing.is_set():  # `shutdown` takes the guard conditions away from an executor that collects them
                raise
