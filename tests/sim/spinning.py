"""Runs an executor in a thread of a test, while the test creates and destroys endpoints in its own thread."""

from __future__ import annotations

import contextlib
import threading
from typing import Any


def spin(executor: Any, closing: threading.Event) -> None:
    """Spin until `closing` is set and the executor was shut down."""
    from rclpy.impl.implementation_singleton import rclpy_implementation

    while not closing.is_set():
        # An endpoint may be destroyed while the executor collects the entities to wait for.
        with contextlib.suppress(rclpy_implementation.InvalidHandle):
            executor.spin()
