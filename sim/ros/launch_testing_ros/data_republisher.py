"""Publishes the messages of a topic on another one, changed or dropped."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.node import Node


class DataRepublisher:
    """Publishes what `transform_fn(message)` returns for each message of `listen_topic`, unless that is None."""

    def __init__(
        self, node: Node, listen_topic: str, publish_topic: str, msg_type: Any, transform_fn: Callable[[Any], Any]
    ) -> None:
        self._node = node
        self._transform = transform_fn
        self._received = 0
        self._republished: list[Any] = []
        self._publisher = node.create_publisher(msg_type, publish_topic, 10)
        self._subscriber = node.create_subscription(msg_type, listen_topic, self._take, 10)

    def shutdown(self) -> None:
        """Take subscription and publisher down."""
        self._node.destroy_subscription(self._subscriber)
        self._node.destroy_publisher(self._publisher)

    def get_num_received(self) -> int:
        return self._received

    def get_num_republished(self) -> int:
        return len(self._republished)

    def get_republished(self) -> list[Any]:
        """Return the messages that were received and not dropped."""
        return self._republished

    def _take(self, message: Any) -> None:
        self._received += 1
        changed = self._transform(message)
        if changed:
            self._republished.append(message)
            self._publisher.publish(changed)
