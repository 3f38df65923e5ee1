"""What DDS itself says about the endpoints of others: asked on the grader's side, whatever they say of themselves.

Every endpoint has a GID, whose first 12 bytes name its participant. What belongs to another participant than the
grader's is the submission's. A publisher that is gone again is counted all the same: to each topic of the simulator
there is a subscription with a deadline that no publisher keeps, and DDS counts the publishers it does not match.

Source: DDSI-RTPS 2.2, 8.2.4 (GUID); ROS 2 documentation, "Quality of Service settings", section "QoS compatibilities".
"""

from __future__ import annotations

import secrets
from collections.abc import Iterator
from typing import Any

from rclpy.duration import Duration
from rclpy.event_handler import QoSSubscriptionEventType
from rclpy.impl.implementation_singleton import rclpy_implementation as rcl
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.type_support import check_is_valid_msg_type
from std_msgs.msg import Empty

from gz_course.grader.run.agent.course_agent.executor_monitor import HOUSEKEEPING
from gz_course.grader.run.processes.progress import Endpoint

PREFIX = 12  # [bytes] of a GID that name the participant
UNKNOWN = "_NODE_NAME_UNKNOWN_"  # rcl's name for the node of an endpoint whose node name is not known yet
KEPT_BY_NOBODY = Duration(nanoseconds=1)


class Discovery:
    """The ROS graph as seen by `node`, without the endpoints of its own participant."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._own = self._own_participant()
        self._watches: dict[str, _Watch] = {}

    def _own_participant(self) -> bytes:
        """Return the prefix of the GIDs of this participant, seen on a topic whose name nobody can guess."""
        topic = f"/course_{secrets.token_hex(16)}"
        publisher = self._node.create_publisher(Empty, topic, 1)
        try:
            (info,) = self._node.get_publishers_info_by_topic(topic)
        finally:
            self._node.destroy_publisher(publisher)
        return bytes(info.endpoint_gid[:PREFIX])

    def watch(self, topic: str, kind: Any) -> None:
        """Count from now on the publishers of others on a topic, those that leave again, too."""
        self._watches[topic] = _Watch(self._node, topic, kind)

    def publishers_seen(self, topic: str) -> bool:
        """Return whether others publish on a topic, or have published since it is watched."""
        own = sum(p.topic_name == topic for p in self._node.publishers)
        watch = self._watches.get(topic)
        return (watch is not None and watch.count() > own) or self._node.count_publishers(topic) > own

    def publishers_counted(self, topic: str) -> int:
        """Return how many publishers there have been on a topic since it is watched, the grader's own included."""
        return self._watches[topic].count()

    def endpoints(self) -> Iterator[Endpoint]:
        """Yield the endpoints of others; the node's name is `UNKNOWN` for a moment after an endpoint has come."""
        for topic, _ in sorted(self._node.get_topic_names_and_types()):
            if topic in HOUSEKEEPING:
                continue
            for kind, infos in (
                ("publisher", self._node.get_publishers_info_by_topic(topic)),
                ("subscription", self._node.get_subscriptions_info_by_topic(topic)),
            ):
                yield from (_endpoint(topic, kind, info) for info in infos if self._is_foreign(info))

    def nodes(self) -> list[str]:
        """Return the full names of all nodes but the grader's own."""
        own = (self._node.get_name(), self._node.get_namespace())
        found = [each for each in self._node.get_node_names_and_namespaces() if each[0] != UNKNOWN]
        if own in found:
            found.remove(own)
        return sorted(_full_name(name, namespace) for name, namespace in found)

    def loggers(self) -> list[str]:
        """Return the full names of the nodes of others whose log goes to /rosout."""
        infos = self._node.get_publishers_info_by_topic("/rosout")
        return sorted({_full_name(i.node_name, i.node_namespace) for i in infos if self._is_foreign(i)})

    def _is_foreign(self, info: Any) -> bool:
        return bytes(info.endpoint_gid[:PREFIX]) != self._own

    def close(self) -> None:
        """Stop to watch."""
        for watch in self._watches.values():
            watch.close()
        self._watches.clear()


class _Watch:
    """A subscription that matches no publisher, and so takes no message, but is told of every one."""

    def __init__(self, node: Node, topic: str, kind: Any) -> None:
        profile = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT, deadline=KEPT_BY_NOBODY)
        check_is_valid_msg_type(kind)  # loads it
        with node.handle:
            self._subscription = rcl.Subscription(node.handle, kind, topic, profile.get_c_qos_profile())
            self._events = [
                rcl.EventHandle(self._subscription, event)
                for event in (
                    QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS,
                    QoSSubscriptionEventType.RCL_SUBSCRIPTION_MATCHED,  # by a publisher that offers this deadline
                )
            ]

    def count(self) -> int:
        """Return how many publishers there have been, the grader's own included."""
        return sum(int(event.take_event().total_count) for event in self._events)

    def close(self) -> None:
        for handle in (*self._events, self._subscription):
            handle.destroy_when_not_in_use()


def _endpoint(topic: str, kind: str, info: Any) -> Endpoint:
    qos = info.qos_profile
    node = UNKNOWN if info.node_name == UNKNOWN else _full_name(info.node_name, info.node_namespace)
    return Endpoint(node, kind, topic, info.topic_type, qos.reliability.name, qos.durability.name, 0)


def _full_name(name: str, namespace: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"
