"""The grader's side of the ROS graph: the bridge to its private simulator, and subscriptions to all student topics.

The bridge is the real `ros_gz_bridge`; only the moment at which its ROS messages are published is decided here, because
in lock-step they are published one at a time.
"""

from __future__ import annotations

import contextlib
from collections import Counter
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

import rclpy
from rcl_interfaces.msg import Log
from rclpy.context import Context
from rclpy.exceptions import InvalidHandle
from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation as rcl
from rclpy.logging import LoggingSeverity, set_logger_level
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import serialize_message
from rclpy.signals import SignalHandlerOptions
from rclpy.subscription import Subscription
from rclpy.type_support import check_is_valid_msg_type

from gz_course.grader.errors import ManifestError
from gz_course.grader.run.agent.course_agent.executor_monitor import HOUSEKEEPING
from gz_course.grader.run.agent.course_agent.history import kept_depth
from gz_course.grader.run.agent.course_agent.rosout_counter import ROSOUT
from gz_course.grader.run.discovery import UNKNOWN, Discovery
from gz_course.grader.run.fair_clock import FairClock, Patience
from gz_course.sim.bridge.ros_gz_bridge.bridge import Bridge, BridgeEntry, HeaderOverrides
from gz_course.sim.gz.transport import Node as GzNode

NAMES = 5.0  # [s] for the names of nodes to arrive
LOOK_AGAIN = 0.02  # [s] between two looks
TAP_DEPTH = 1000
# Also what was logged before the grader's subscription was found; more than one node may be about to be found.
ROSOUT_QOS = QoSProfile(depth=5000, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
LARGE = 60_000  # [bytes] in one UDP packet; fragments of a larger message may be lost
MOST_AT_ONCE = 1000  # messages taken in one call, so that a flood does not stop the grader
NODE = "ros_gz_bridge"


def message_class(ros_type: str) -> Any:
    """Return the Python class of a ROS type such as `std_msgs/msg/Float32`. Raises ManifestError if there is none."""
    package, _, name = ros_type.partition("/msg/")
    try:
        return getattr(import_module(f"{package}.msg"), name)
    except (ImportError, AttributeError):
        raise ManifestError(f"there is no ROS message type {ros_type!r} here") from None


def ros_twist(linear_x: float, angular_z: float) -> Any:
    """Return a `geometry_msgs/msg/Twist` of these velocities [m/s], [rad/s]."""
    twist = message_class("geometry_msgs/msg/Twist")()
    twist.linear.x, twist.angular.z = linear_x, angular_z
    return twist


class GraderEndpoints:
    """Owns an rclpy context in `domain`, the bridge for `entries`, and a subscription to each topic in `observe`.

    `heard(topic, message)` is called for every message that arrives from the student, `logged(message)` for every one
    on /rosout. `discovery` shows the endpoints of others; with `watch` it notes who publishes on the bridge's topics.
    `parameters` are ROS parameters of the bridge, such as `qos_overrides./tf_static.publisher.durability`.
    """

    def __init__(
        self,
        domain: int,
        gz_node: GzNode,
        entries: list[BridgeEntry],
        observe: dict[str, str],
        heard: Callable[[str, Any], None],
        logged: Callable[[Any], None] = lambda message: None,
        watch: bool = False,
        parameters: Mapping[str, str] | None = None,
    ) -> None:
        kinds = {topic: message_class(kind) for topic, kind in observe.items()}
        self.held: list[tuple[str, Any, Any]] = []
        self._gz_node = gz_node
        self._observe = observe
        self.offered = {e.ros_topic: e.ros_type for e in entries if e.direction.to_ros}
        self.listened = {e.ros_topic: e.ros_type for e in entries if e.direction.to_gz} | observe
        self.received: Counter[str] = Counter()
        self.found_at: dict[str, int] = {}  # topic -> [ns] of real time: older messages are none of ours
        self.look: Callable[[], None] = lambda: None  # brings `found_at` up to date
        self._heard = heard
        self._context = Context()
        # No arguments: the grader's own are not meant for ROS.
        rclpy.init(args=[], context=self._context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
        with contextlib.ExitStack() as stack:  # an executor that is not shut down complains when Python exits
            stack.callback(rclpy.shutdown, context=self._context)
            set_logger_level(NODE, LoggingSeverity.ERROR)  # the report contains what it would log
            self._node = rclpy.create_node(
                NODE,
                context=self._context,
                start_parameter_services=False,
                enable_rosout=False,
                parameter_overrides=[Parameter(name, value=value) for name, value in (parameters or {}).items()],
            )
            stack.callback(self._node.destroy_node)
            self._executor = _Executor(self, context=self._context)
            stack.callback(self._executor.shutdown)
            self._executor.add_node(self._node)
            self.bridge = Bridge(self._node, gz_node, entries, publish=self._hold, heard=self._bridge_heard)
            stack.callback(lambda: self.bridge.close())
            for topic, kind in kinds.items():
                self._node.create_subscription(kind, topic, self._tap(topic), _tap_qos(topic))
            self._logged = logged
            # Outside the executor, which would look at it whenever it looks at anything.
            check_is_valid_msg_type(Log)  # loads it
            with self._node.handle:
                self._log = rcl.Subscription(self._node.handle, Log, ROSOUT, ROSOUT_QOS.get_c_qos_profile())
            stack.callback(self._log.destroy_when_not_in_use)
            self._look_at_own()
            self.discovery = Discovery(self._node)
            stack.callback(self.discovery.close)
            for topic, kind in self.offered.items() if watch else ():
                self.discovery.watch(topic, message_class(kind))
            self._open = stack.pop_all()

    def set_bridges(self, entries: list[BridgeEntry], overrides: HeaderOverrides | None = None) -> None:
        """Replace the bridges. Raises BridgeError, and leaves no bridge, if an entry cannot be bridged."""
        self.bridge.close()
        self.bridge = Bridge(self._node, self._gz_node, [])
        self.bridge = Bridge(
            self._node, self._gz_node, entries, publish=self._hold, heard=self._bridge_heard, overrides=overrides
        )
        self.offered = {e.ros_topic: e.ros_type for e in entries if e.direction.to_ros}
        self.listened = {e.ros_topic: e.ros_type for e in entries if e.direction.to_gz} | self._observe
        self._look_at_own()

    def _look_at_own(self) -> None:
        # One publisher and one subscription per topic, so that one match on either side is a complete match.
        self._publishers = {p.topic_name: p for p in self._node.publishers if p.topic_name in self.offered}
        self._keeps = {topic: kept_depth(p.qos_profile) for topic, p in self._publishers.items()}
        self._subscriptions = {s.topic_name: s for s in self._node.subscriptions if s.topic_name in self.listened}
        # A bidirectional entry receives its own messages; that is not a match with the student.
        self._own_publishers = Counter(p.topic_name for p in self._node.publishers)
        self._own_subscriptions = Counter(s.topic_name for s in self._node.subscriptions)

    def _hold(self, publisher: Any, message: Any) -> None:
        self.held.append((publisher.topic_name, publisher, message))

    def _bridge_heard(self, entry: BridgeEntry, message: Any) -> None:
        self._count(entry.ros_topic, message)

    def _tap(self, topic: str) -> Callable[[Any], None]:
        return lambda message: self._count(topic, message)

    def _count(self, topic: str, message: Any) -> None:
        self.received[topic] += 1
        self._heard(topic, message)

    def client(self, kind: Any, service: str) -> Any:
        """Return a client of a service that the submission may offer."""
        return self._node.create_client(kind, service)

    def take_logs(self) -> None:
        """Take what has arrived on /rosout, at most `MOST_AT_ONCE` messages."""
        for _ in range(MOST_AT_ONCE):
            taken = self._log.take_message(Log, False)
            if taken is None:
                return
            self.received[ROSOUT] += 1
            self._logged(taken[0])

    def take_held(self) -> list[tuple[str, Any, Any]]:
        """Return what the simulator published since the last call: /clock first, then by topic name.

        A node that reads its clock when a scan arrives then gets the time of that scan, not of the one before.
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
        """Return the ROS type that the bridge publishes on a topic, or None."""
        return self.offered.get(topic)

    def listens(self, topic: str) -> str | None:
        """Return the ROS type to which the grader subscribes on a topic, or None."""
        return self.listened.get(topic)

    def matched(self, topic: str, kind: str) -> int:
        """Return how many of the student's endpoints of a kind (publisher, subscription) are matched on a topic."""
        if kind == "subscription":
            publisher, own = self._publishers.get(topic), self._own_subscriptions[topic]
            return max(0, int(publisher.get_subscription_count()) - own) if publisher else 0
        subscription, own = self._subscriptions.get(topic), self._own_publishers[topic]
        return max(0, int(subscription.get_publisher_count()) - own) if subscription else 0

    def reliable(self, topic: str) -> bool:
        """Return whether the bridge publishes reliably on a topic, so that reliable subscriptions match."""
        publisher = self._publishers.get(topic)
        return publisher is None or publisher.qos_profile.reliability != ReliabilityPolicy.BEST_EFFORT

    def keeps(self, topic: str) -> int:
        """Return how many messages the bridge keeps on a topic for subscriptions that join late."""
        return self._keeps.get(topic, 0)

    def is_large(self, message: Any) -> bool:
        """Return whether a message needs several packets and has a stamp that distinguishes it from the next."""
        return hasattr(message, "header") and len(serialize_message(message)) > LARGE

    def bridged(self) -> list[dict[str, Any]]:
        """Return every bridge as it was set up and the number of messages it passed in each direction."""
        found = []
        for status in self.bridge.status():
            entry = status.entry
            publisher, subscription = self._publishers.get(entry.ros_topic), self._subscriptions.get(entry.ros_topic)
            found.append(
                {
                    "source": entry.place,
                    "ros_topic": entry.ros_topic,
                    "ros_type": entry.ros_type,
                    "gz_topic": entry.gz_topic,
                    "gz_type": entry.gz_type,
                    "direction": entry.direction.value,
                    "to_ros": status.gz_to_ros,
                    "to_gz": status.ros_to_gz,
                    "publisher_qos": _qos(publisher) if entry.direction.to_ros else None,
                    "subscription_qos": _qos(subscription) if entry.direction.to_gz else None,
                }
            )
        return found

    def ros_graph(self, clock: FairClock) -> dict[str, dict[str, list[str]]]:
        """Return the ROS graph as seen from here: topic -> types, publishing and subscribing nodes.

        Waits, for at most `NAMES` seconds, until the name of every endpoint's node is known.
        """
        patience = Patience(clock, NAMES)
        while True:
            graph = self._graph()
            unknown = any(UNKNOWN in ends["publishers"] + ends["subscribers"] for ends in graph.values())
            if not unknown or patience.over():
                return graph
            self.look_again()

    def _graph(self) -> dict[str, dict[str, list[str]]]:
        node = self._node
        return {
            topic: {
                "types": sorted(types),
                "publishers": sorted({end.node_name for end in node.get_publishers_info_by_topic(topic)}),
                "subscribers": sorted({end.node_name for end in node.get_subscriptions_info_by_topic(topic)}),
            }
            for topic, types in sorted(node.get_topic_names_and_types())
            if topic not in HOUSEKEEPING
        }

    def look_again(self) -> None:
        """Let discovery go on for a moment."""
        self._executor.spin_once(timeout_sec=LOOK_AGAIN)

    def close(self) -> None:
        """Leave the ROS graph."""
        self._open.close()


class _Executor(SingleThreadedExecutor):
    """Ignores messages older than the moment at which their publisher was found (`found_at`), if none are kept."""

    def __init__(self, endpoints: GraderEndpoints, **options: Any) -> None:
        super().__init__(**options)
        self._endpoints = endpoints

    def _take_subscription(self, sub: Any) -> Any:
        if not self._endpoints.listens(sub.topic_name) or _is_kept(sub.topic_name):
            return super()._take_subscription(sub)
        try:
            with sub.handle:
                taken = sub.handle.take_message(sub.msg_type, sub.raw)
        except InvalidHandle:  # destroyed since it became ready
            return None
        self._endpoints.look()
        if taken is None or taken[1]["source_timestamp"] < self._endpoints.found_at.get(sub.topic_name, 0):
            return None

        with_info = sub._callback_type is Subscription.CallbackType.WithMessageInfo

        async def call() -> None:
            sub.callback(*(taken if with_info else taken[:1]))

        return call


def _tap_qos(topic: str) -> QoSProfile:
    """Return the QoS of the grader's own subscription to a topic."""
    durability = DurabilityPolicy.TRANSIENT_LOCAL if _is_kept(topic) else DurabilityPolicy.VOLATILE
    return QoSProfile(depth=TAP_DEPTH, durability=durability)


def _is_kept(topic: str) -> bool:
    """Return whether the grader takes what was published before its subscription was found: static transforms."""
    return topic.rpartition("/")[2] == "tf_static"


def _qos(endpoint: Any) -> dict[str, Any]:
    """Return the QoS of a publisher or subscription of the bridge."""
    profile = endpoint.qos_profile
    return {"reliability": profile.reliability.name, "durability": profile.durability.name, "depth": profile.depth}
