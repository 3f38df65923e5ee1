"""Spins a node in a thread while a test does something else."""

from __future__ import annotations

import threading
from types import TracebackType

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node


class MessagePump:
    """Spins `node` from `start()` to `stop()`; also as `with MessagePump(node):`."""

    def __init__(self, node: Node, context: rclpy.context.Context | None = None) -> None:
        self._node = node
        self._executor = SingleThreadedExecutor(context=context)
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._spin, name="message_pump", daemon=True)

    def start(self) -> None:
        self._executor.add_node(self._node)
        self._thread.start()

    def stop(self) -> None:
        """End the thread. Raises RuntimeError if a callback does not return within 5 s."""
        self._stopping.set()
        self._executor.wake()
        self._thread.join(timeout=5.0)
        if self._thread.is_alive():
            raise RuntimeError("Timed out waiting for message pump to stop")
        self._executor.remove_node(self._node)

    def __enter__(self) -> MessagePump:
        self.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    def _spin(self) -> None:
        while not self._stopping.is_set():
            self._executor.spin_once(timeout_sec=1.0)
