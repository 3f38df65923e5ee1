"""The running bridge: takes messages from one side, converts them, publishes them on the other.

It joins a ROS node and a Gazebo node that somebody else owns and spins: ROS messages arrive in the executor's
thread, Gazebo messages in the thread that delivers them (the publisher's own, or the dispatcher of
``gz.transport``). Commands that are not finite numbers stop here, before they can reach the simulator.
"""

from __future__ import annotations

import dataclasses
import re
import threading
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from gz.transport import AdvertiseMessageOptions, SubscribeOptions, naming
from gz.transport import Node as GzNode
from rclpy.clock import Clock, ClockType
from rclpy.exceptions import InvalidHandle
from rclpy.node import Node as RosNode
from rclpy.publisher import Publisher
from rclpy.qos import QoSPolicyKind, QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.timer import Timer

from ros_gz_bridge.echo_filter import EchoAwarePublisher, EchoFilter, GzEcho
from ros_gz_bridge.entry import BridgeEntry, Direction
from ros_gz_bridge.type_pairs import TypePair, UnknownPairError, find_pair

__all__ = [
    "Bridge",
    "BridgeEntry",
    "BridgeError",
    "Direction",
    "EntryStatus",
    "HeaderOverrides",
    "error_text",
]

_ECHO_MARGIN = 16
_PUBLISHER_POLICIES = (
    QoSPolicyKind.DEADLINE,
    QoSPolicyKind.DEPTH,
    QoSPolicyKind.DURABILITY,
    QoSPolicyKind.HISTORY,
    QoSPolicyKind.LIVELINESS,
    QoSPolicyKind.RELIABILITY,
)


class BridgeError(RuntimeError):
    """Entries that cannot be set up; ``errors`` holds one sentence for each."""

    def __init__(self, errors: Iterable[str]) -> None:
        self.errors = list(errors)
        super().__init__("\n".join(self.errors))


@dataclass(frozen=True)
class HeaderOverrides:
    """What a bridge writes over the header of every message going to ROS.

    ``frame_id`` replaces the frame unless the entry has one of its own; ``wall_time`` replaces the stamp with
    the system clock.
    """

    frame_id: str = ""
    wall_time: bool = False


@dataclass
class EntryStatus:
    """What went through one entry so far, in messages.

    ``dropped`` were refused or could not be converted (``last_error`` says why); ``echoes`` are the bridge's
    own messages coming back, which are ignored.
    """

    entry: BridgeEntry
    ros_to_gz: int = 0
    gz_to_ros: int = 0
    dropped: int = 0
    echoes: int = 0
    last_error: str | None = None


@dataclass(frozen=True)
class _Row:
    entry: BridgeEntry
    status: EntryStatus
    pair: TypePair
    ros_topic: str


class Bridge:
    """Bridges ``entries`` between ``ros_node`` and ``gz_node`` until ``close``.

    Give it a Gazebo node of its own: closing drops every subscription that node has on the bridged topics.
    The ROS node may have other endpoints; it must be spun by its owner for messages from ROS to pass.
    ``publish`` receives each ROS publisher and the message meant for it, and decides when it leaves; by
    default it leaves at once. ``heard`` is shown every message that comes from ROS, before it is judged and
    converted. ``heartbeat`` (s) is how often lazy entries look for listeners. Raises
    ``BridgeError`` listing every entry that cannot work, and then leaves nothing behind.
    """

    def __init__(
        self,
        ros_node: RosNode,
        gz_node: GzNode,
        entries: Iterable[BridgeEntry],
        publish: Callable[[Publisher, Any], None] | None = None,
        *,
        heard: Callable[[BridgeEntry, Any], None] | None = None,
        overrides: HeaderOverrides | None = None,
        heartbeat: float = 1.0,
    ) -> None:
        self.entries = list(entries)
        self._ros_node = ros_node
        self._gz_node = gz_node
        self._publish = publish or _publish_now
        self._heard = heard
        self._overrides = overrides or HeaderOverrides()
        self._gz_echo = GzEcho()
        self._announced: set[tuple[str, str]] = set()
        self._to_ros: list[_GzToRos] = []
        self._to_gz: list[_RosToGz] = []
        self._gz_publishers: dict[str, Any] = {}
        self._timer: Timer | None = None
        self._status = [EntryStatus(entry) for entry in self.entries]
        self._status_lock = threading.Lock()
        rows = self._checked()
        try:
            self._set_up(rows)
            if any(entry.lazy for entry in self.entries):
                steady = Clock(clock_type=ClockType.STEADY_TIME)
                self._timer = ros_node.create_timer(heartbeat, self._connect_lazy, clock=steady)
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Bridge:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def status(self) -> list[EntryStatus]:
        """The counters of every entry, in the order given; a copy that does not change any more."""
        with self._status_lock:
            return [dataclasses.replace(status) for status in self._status]

    def close(self) -> None:
        """Give back every publisher, subscription and timer; harmless when repeated. Counters stay."""
        if self._timer is not None:
            self._ros_node.destroy_timer(self._timer)
            self._timer = None
        for incoming in self._to_ros:
            incoming.close()
        for outgoing in self._to_gz:
            outgoing.close()
        for publisher in self._gz_publishers.values():
            publisher.close()
        self._gz_publishers.clear()

    def _checked(self) -> list[_Row]:
        """Every entry with its pair and its topic as ROS names it, after remapping."""
        rows, errors = [], []
        for entry, status in zip(self.entries, self._status, strict=True):
            try:
                pair = find_pair(entry.ros_type, entry.gz_type)
                rows.append(_Row(entry, status, pair, self._ros_node.resolve_topic_name(entry.ros_topic)))
            except UnknownPairError as error:
                errors.append(_sentence(entry, str(error)))
            except Exception as error:
                errors.append(_sentence(entry, f"cannot bridge {entry.ros_topic}: {error_text(error)}"))
        if errors:
            raise BridgeError(errors)
        return rows

    def _set_up(self, rows: list[_Row]) -> None:
        """Create every endpoint: publishers first, so that no message arrives with nowhere to go."""
        filters = _echo_filters(rows)
        errors = []
        for row in rows:
            try:
                if row.entry.direction.to_ros:
                    heard_by = tuple(own for other, own in filters if other.ros_topic == row.ros_topic)
                    self._to_ros.append(_GzToRos(self, row, heard_by))
                if row.entry.direction.to_gz:
                    own_filter = next((own for other, own in filters if other is row), None)
                    self._to_gz.append(_RosToGz(self, row, own_filter))
            except Exception as error:
                errors.append(
                    _sentence(row.entry, f"cannot bridge {row.entry.ros_topic}: {error_text(error)}")
                )
        if errors:
            raise BridgeError(errors)
        for link in self._links():
            if not link.entry.lazy:
                link.connect()

    def _links(self) -> list[_GzToRos | _RosToGz]:
        return [*self._to_ros, *self._to_gz]

    def _connect_lazy(self) -> None:
        for link in self._links():
            if link.entry.lazy:
                if link.wanted():
                    link.connect()
                else:
                    link.disconnect()

    def _gz_name(self, topic: str) -> str:
        """The Gazebo topic as others see it: namespace and remapping of the node applied."""
        options = self._gz_node.options
        return naming.split(naming.fully_qualified("", options.namespace, options.topic_remap(topic)))[1]

    def _gz_publisher(self, topic: str, pair: TypePair) -> Any:
        """One Gazebo publisher a topic, however many entries feed it."""
        name = self._gz_name(topic)
        publisher = self._gz_publishers.get(name)
        if publisher is None:
            publisher = self._gz_node.advertise(topic, pair.gz_class, AdvertiseMessageOptions())
            self._gz_publishers[name] = publisher
        elif publisher.type_name != pair.gz_type:
            raise ValueError(
                f"the Gazebo topic {topic} carries {publisher.type_name} already, not {pair.gz_type}"
            )
        return publisher

    def _disconnect_gz(self, topic: str) -> None:
        """Leave a Gazebo topic once no entry listens to it any more (leaving is for the whole topic)."""
        listeners = [link for link in self._to_ros if link.gz_topic == topic]
        if not any(link.connected for link in listeners):
            self._gz_node.unsubscribe(topic)
            for link in listeners:
                link.subscribed = False

    def _announce(self, pair: TypePair) -> None:
        key = (pair.ros_type, pair.gz_type)
        if key not in self._announced:
            self._announced.add(key)
            self._ros_node.get_logger().info(
                f"Passing message from ROS {pair.ros_type} to Gazebo {pair.gz_type} "
                "(showing msg only once per type)"
            )


class _Link:
    """What both directions of an entry share: counting, and one warning for a run of bad messages."""

    def __init__(self, bridge: Bridge, row: _Row) -> None:
        self.entry = row.entry
        self.ros_topic = row.ros_topic
        self.connected = False
        self._bridge = bridge
        self.gz_topic = bridge._gz_name(row.entry.gz_topic)
        self._pair = row.pair
        self._status = row.status
        self._closed = False
        self._dropping = False

    def _count(self, field: str) -> None:
        with self._bridge._status_lock:
            setattr(self._status, field, getattr(self._status, field) + 1)

    def _passed(self, field: str) -> None:
        self._dropping = False
        self._count(field)

    def _drop(self, ros_or_gz_type: str, topic: str, reason: str) -> None:
        sentence = f"{ros_or_gz_type} on {topic} was not bridged: {reason}"
        with self._bridge._status_lock:
            self._status.dropped += 1
            self._status.last_error = sentence
        if not self._dropping:
            self._dropping = True
            self._bridge._ros_node.get_logger().warning(
                f"{sentence} (said once, until a message passes this bridge again)"
            )


class _GzToRos(_Link):
    """One entry's way from Gazebo to ROS."""

    def __init__(self, bridge: Bridge, row: _Row, heard_by: tuple[EchoFilter, ...]) -> None:
        super().__init__(bridge, row)
        self.subscribed = False
        self.publisher = bridge._ros_node.create_publisher(
            row.pair.ros_class,
            row.entry.ros_topic,
            QoSProfile(depth=row.entry.publisher_queue),
            qos_overriding_options=QoSOverridingOptions(_PUBLISHER_POLICIES),
            publisher_class=EchoAwarePublisher if heard_by else Publisher,
        )
        if heard_by:
            self.publisher.filters = heard_by

    def wanted(self) -> bool:
        """Whether anybody but this bridge listens on the ROS side."""
        own = sum(link.connected and link.ros_topic == self.ros_topic for link in self._bridge._to_gz)
        return bool(self.publisher.get_subscription_count() > own)

    def connect(self) -> None:
        """Listen to Gazebo. Raises ``BridgeError`` when ``gz.transport`` refuses."""
        self.connected = True
        if not self.subscribed:
            self.subscribed = True
            if not self._bridge._gz_node.subscribe(
                self._pair.gz_class, self.entry.gz_topic, self._on_message, SubscribeOptions()
            ):
                raise BridgeError(
                    [_sentence(self.entry, f"cannot subscribe to the Gazebo topic {self.entry.gz_topic}")]
                )

    def disconnect(self) -> None:
        """Stop listening to Gazebo."""
        if self.connected:
            self.connected = False
            self._bridge._disconnect_gz(self.gz_topic)

    def close(self) -> None:
        """Stop listening and give back the publisher; a message on its way through may still leave."""
        self.disconnect()
        if not self._closed:
            self._closed = True
            self._bridge._ros_node.destroy_publisher(self.publisher)

    def _on_message(self, gz: Any) -> None:
        if not self.connected:
            return
        if self._bridge._gz_echo.is_echo(self.gz_topic, gz):
            self._count("echoes")
            return
        try:
            ros = self._pair.to_ros(gz)
            self._override_header(ros)
        except Exception as error:
            self._drop(self._pair.gz_type, self.entry.gz_topic, str(error))
            return
        try:
            self._bridge._publish(self.publisher, ros)
        except InvalidHandle:
            if not self._closed:
                raise
            return
        self._passed("gz_to_ros")

    def _override_header(self, ros: Any) -> None:
        header = getattr(ros, "header", None)
        if header is None:
            return
        overrides = self._bridge._overrides
        if frame_id := self.entry.frame_id or overrides.frame_id:
            header.frame_id = frame_id
        if overrides.wall_time:
            header.stamp.sec, header.stamp.nanosec = divmod(time.time_ns(), 10**9)


class _RosToGz(_Link):
    """One entry's way from ROS to Gazebo."""

    def __init__(self, bridge: Bridge, row: _Row, echo_filter: EchoFilter | None) -> None:
        super().__init__(bridge, row)
        self._echo_filter = echo_filter
        self._publisher = bridge._gz_publisher(row.entry.gz_topic, row.pair)
        self.subscription: Any = None

    def wanted(self) -> bool:
        """Whether anybody listens on the Gazebo side (a bidirectional entry hears itself, so always)."""
        return bool(self._publisher.has_connections())

    def connect(self) -> None:
        """Listen to ROS."""
        if self.connected:
            return
        self.connected = True
        # rclpy looks at the number of parameters: with two it passes the stamps of the message along.
        self.subscription = self._bridge._ros_node.create_subscription(
            self._pair.ros_class,
            self.entry.ros_topic,
            self._on_message if self._echo_filter is None else self._on_message_with_info,
            QoSProfile(depth=self.entry.subscriber_queue),
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
        )

    def disconnect(self) -> None:
        """Stop listening to ROS."""
        self.connected = False
        if self.subscription is not None:
            self._bridge._ros_node.destroy_subscription(self.subscription)
            self.subscription = None

    def close(self) -> None:
        """Stop listening; a message on its way through may still leave."""
        self.disconnect()

    def _on_message_with_info(self, ros: Any, info: dict[str, int]) -> None:
        if self._echo_filter is not None and self._echo_filter.is_echo(ros, info["source_timestamp"]):
            self._count("echoes")
        else:
            self._on_message(ros)

    def _on_message(self, ros: Any) -> None:
        if not self.connected:
            return
        if self._bridge._heard is not None:
            self._bridge._heard(self.entry, ros)
        pair = self._pair
        fault = pair.fault(ros) if pair.fault is not None else None
        if fault is not None:
            self._drop(pair.ros_type, self.entry.ros_topic, f"{fault}; only finite numbers can be commanded")
            return
        try:
            gz = pair.to_gz(ros)
        except Exception as error:
            self._drop(pair.ros_type, self.entry.ros_topic, str(error))
            return
        self._bridge._announce(pair)
        with self._bridge._gz_echo.publishing(self.gz_topic, gz):
            taken = self._publisher.publish(gz)
        if taken:
            self._passed("ros_to_gz")
        else:
            self._drop(
                pair.ros_type, self.entry.ros_topic, f"gz.transport refused it on {self.entry.gz_topic}"
            )


def _publish_now(publisher: Publisher, message: Any) -> None:
    publisher.publish(message)


def _echo_filters(rows: list[_Row]) -> list[tuple[_Row, EchoFilter]]:
    """A filter for every entry that listens to a ROS topic which one of the entries publishes."""
    depths: dict[str, int] = {}
    for row in rows:
        if row.entry.direction.to_ros:
            depths[row.ros_topic] = depths.get(row.ros_topic, 0) + row.entry.publisher_queue
    return [
        (
            row,
            EchoFilter(
                _content_of(row.pair), depths[row.ros_topic] + row.entry.subscriber_queue + _ECHO_MARGIN
            ),
        )
        for row in rows
        if row.entry.direction.to_gz and row.ros_topic in depths
    ]


def _content_of(pair: TypePair) -> Callable[[Any], bytes]:
    """The bytes by which an echo filter compares ROS messages: what would be sent to Gazebo."""

    def content(ros: Any) -> bytes:
        try:
            return bytes(pair.to_gz(ros).SerializeToString())
        except Exception:  # it would be dropped, not bridged, so all such messages are alike
            return b""

    return content


def error_text(error: BaseException) -> str:
    """The text of an error in one line, without the places in ROS's C sources that it may carry."""
    return re.sub(r", at /\S+:\d+", "", " ".join(str(error).split())) or type(error).__name__


def _sentence(entry: BridgeEntry, text: str) -> str:
    return f"{entry.source}: {text}" if entry.source else text
