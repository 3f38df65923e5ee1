"""The grader's own end of the ROS graph: the bridge to its private simulator, and a tap on every student topic.

The bridge is the real `ros_gz_bridge`; only the moment at which its ROS messages leave is decided here, because in
lock-step they leave one at a time.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from importlib import import_module
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.logging import LoggingSeverity, set_logger_level
from rclpy.qos import QoSProfile
from rclpy.signals import SignalHandlerOptions

from grader.errors import ManifestError
from gz.transport import Node as GzNode
from ros_gz_bridge.bridge import Bridge, BridgeEntry

TAP_DEPTH = 1000
MOST_AT_ONCE = 1000  # messages taken in one go: a flood does not keep the grader from going on
NODE = "ros_gz_bridge"


def message_class(ros_type: str) -> Any:
    """Return the Python class of a ROS type such as `std_msgs/msg/Float32`. Raises ManifestError if there is none."""
    package, _, name = ros_type.partition("/msg/")
    try:
        return getattr(import_module(f"{package}.msg"), name)
    except (ImportError, AttributeError):
        raise ManifestError(f"there is no ROS message type {ros_type!r} here") from None


class Ears:
    """Owns an rclpy context in `domain`, the bridge for `entries`, and a tap on each topic in `observe`.

    `heard(topic, message)` is called for every message that arrives from the student.
    """

    def __init__(
        self,
        domain: int,
        gz_node: GzNode,
        entries: list[BridgeEntry],
        observe: dict[str, str],
        heard: Callable[[str, Any], None],
    ) -> None:
        self._context = Context()
        # No arguments: ours are not meant for ROS.
        rclpy.init(args=[], context=self._context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
        set_logger_level(NODE, LoggingSeverity.ERROR)  # what it would say is told in the report
        self._node = rclpy.create_node(NODE, context=self._context, start_parameter_services=False)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self.held: list[tuple[str, Any, Any]] = []
        self.bridge = Bridge(self._node, gz_node, entries, publish=self._hold, heard=self._bridge_heard)
        self.offered = {e.ros_topic: e.ros_type for e in entries if e.direction.to_ros}
        self.listened = {e.ros_topic: e.ros_type for e in entries if e.direction.to_gz} | observe
        self.received: Counter[str] = Counter()
        self._heard = heard
        for topic, kind in observe.items():
            self._node.create_subscription(message_class(kind), topic, self._tap(topic), QoSProfile(depth=TAP_DEPTH))
        # One publisher and one subscription a topic, so one match on either side is a complete match.
        self._publishers = {p.topic_name: p for p in self._node.publishers if p.topic_name in self.offered}
        self._subscriptions = {s.topic_name: s for s in self._node.subscriptions if s.topic_name in self.listened}

    def _hold(self, publisher: Any, message: Any) -> None:
        self.held.append((publisher.topic_name, publisher, message))

    def _bridge_heard(self, entry: BridgeEntry, message: Any) -> None:
        self._count(entry.ros_topic, message)

    def _tap(self, topic: str) -> Callable[[Any], None]:
        return lambda message: self._count(topic, message)

    def _count(self, topic: str, message: Any) -> None:
        self.received[topic] += 1
        self._heard(topic, message)

    def take_held(self) -> list[tuple[str, Any, Any]]:
        """Return what the simulator published since the last call: /clock first, then by topic name.

        A node that looks at its clock when a scan arrives then finds the time of that scan, not the one before.
        """
        held, self.held = self.held, []
        return sorted(held, key=lambda item: (item[0] != "/clock", item[0]))

    def dropped(self) -> dict[str, int]:
        """Return how many messages the bridge refused, by ROS topic."""
        return {s.entry.ros_topic: s.dropped for s in self.bridge.status() if s.dropped}

    def pump(self) -> None:
        """Take what has arrived, without waiting and at most `MOST_AT_ONCE` messages."""
        for _ in range(MOST_AT_ONCE):
            before = self.received.total()
            self._executor.spin_once(timeout_sec=0)
            if self.received.total() == before:
                return

    def publishes(self, topic: str) -> str | None:
        """ROS type of what the bridge publishes on a topic, or None."""
        return self.offered.get(topic)

    def listens(self, topic: str) -> str | None:
        """ROS type of what is subscribed to here on a topic, or None."""
        return self.listened.get(topic)

    def matched(self, topic: str, kind: str) -> int:
        """How many of the student's endpoints of a kind (publisher, subscription) are matched on a topic."""
        if kind == "subscription":
            return int(self._publishers[topic].get_subscription_count()) if topic in self._publishers else 0
        return int(self._subscriptions[topic].get_publisher_count()) if topic in self._subscriptions else 0

    def close(self) -> None:
        """Leave the ROS graph."""
        self.bridge.close()
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.shutdown(context=self._context)
