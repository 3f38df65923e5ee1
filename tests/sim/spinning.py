"""Runs an executor in a thread of a test, while the test creates and destroys endpoints in its own thread."""

from __future__ import annotations

import threading
from typing import Any


def spin(executor: Any, closing: threading.Event) -> None:
    """Spin until `closing` is set and the executor was shut down."""
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
