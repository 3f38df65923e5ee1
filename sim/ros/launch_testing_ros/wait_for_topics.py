"""Waits until messages have come on topics."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from types import TracebackType
from typing import Any

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

_names = iter(range(1, 1 << 62))


class WaitForTopics:
    """Waits for a message on each of some topics, given as name and type; the last ones are kept.

    with WaitForTopics([("chatter", String)], timeout=5.0) as topics:
        topics.received_messages("chatter")

    `trigger(node)` is called when the subscriptions stand.
    """

    def __init__(
        self,
        topic_tuples: Iterable[tuple[str, Any]],
        timeout: float = 5.0,
        messages_received_buffer_length: int = 10,
        trigger: Callable[[Node], object] | None = None,
        node_namespace: str | None = None,
    ) -> None:
        self.topic_tuples = list(topic_tuples)
        self.timeout = timeout
        self._kept = messages_received_buffer_length
        self._trigger = trigger
        self._messages: dict[str, list[Any]] = {name: [] for name, _ in self.topic_tuples}
        self._unsubscribed = list(self.topic_tuples)
        self._changed = threading.Condition()
        self._context = rclpy.context.Context()
        rclpy.init(context=self._context)
        self._node = Node(f"test_node_{next(_names)}", context=self._context, namespace=node_namespace)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._running = True
        self._thread = threading.Thread(target=self._spin, name="wait_for_topics", daemon=True)
        self._thread.start()

    def wait(self) -> bool:
        """Wait for new messages, at most `timeout` [s]; return whether they have come on every topic."""
        with self._changed:
            for messages in self._messages.values():
                messages.clear()
        while self._unsubscribed:
            name, kind = self._unsubscribed.pop()
            self._node.create_subscription(kind, name, lambda message, name=name: self._take(name, message), 10)
        if self._trigger is not None:
            self._trigger(self._node)
        with self._changed:
            return self._changed.wait_for(lambda: not self.topics_not_received(), timeout=self.timeout)

    def shutdown(self) -> None:
        """End the node and its thread."""
        self._running = False
        self._executor.wake()
        self._thread.join()
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.shutdown(context=self._context)

    def topics_received(self) -> set[str]:
        return {name for name, messages in self._messages.items() if messages}

    def topics_not_received(self) -> set[str]:
        return set(self._messages) - self.topics_received()

    def received_messages(self, topic_name: str) -> list[Any]:
        """Return the last messages of a topic. Raises KeyError for a topic that is not waited for."""
        if topic_name not in self._messages:
            raise KeyError(f"No topic named {topic_name} is waited for")
        return list(self._messages[topic_name])

    def __enter__(self) -> WaitForTopics:
        if not self.wait():
            missing = sorted(self.topics_not_received())
            self.shutdown()
            raise RuntimeError(f"Did not receive messages on these topics: {missing}")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.shutdown()

    def _spin(self) -> None:
        while self._running:
            self._executor.spin_once(timeout_sec=1.0)

    def _take(self, name: str, message: Any) -> None:
        with self._changed:
            kept = self._messages[name]
            kept.append(message)
            del kept[: -self._kept]
            self._changed.notify_all()
