"""The two directions of an entry of a bridge: from Gazebo to ROS, and from ROS to Gazebo.

`bridge.Bridge` makes one link for each direction of each entry. A link owns its endpoint on the ROS side, converts and
counts messages, and warns at most once per second about messages that could not be bridged.
"""

from __future__ import annotations

import re
import time
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rclpy.exceptions import InvalidHandle
from rclpy.publisher import Publisher
from rclpy.qos import QoSPolicyKind
from rclpy.qos_overriding_options import QoSOverridingOptions

from gz_course.sim.bridge.ros_gz_bridge.echo_filter import EchoAwarePublisher, EchoFilter
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, BridgeError, EntryStatus, ServiceEntry
from gz_course.sim.bridge.ros_gz_bridge.qos_profile import PUBLISHER_POLICIES, qos
from gz_course.sim.bridge.ros_gz_bridge.remarks import converted
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import TypePair
from gz_course.sim.bridge.ros_gz_bridge.worker import HEAVY_BYTES, Worker
from gz_course.sim.gz.transport import MessageInfo, SubscribeOptions

if TYPE_CHECKING:
    from gz_course.sim.bridge.ros_gz_bridge.bridge import Bridge

_PUBLISHER_POLICIES = tuple(QoSPolicyKind[name.upper()] for name in PUBLISHER_POLICIES)
_SECONDS_BETWEEN_WARNINGS = 1.0


@dataclass(frozen=True)
class Row:
    """An entry with its counters, its type pair and its ROS topic after remapping."""

    entry: BridgeEntry
    status: EntryStatus
    pair: TypePair
    ros_topic: str


class Link:
    """The common part of both directions: counters, and warnings about messages that could not be bridged."""

    def __init__(self, bridge: Bridge, row: Row) -> None:
        self.entry = row.entry
        self.ros_topic = row.ros_topic
        self.connected = False
        self._bridge = bridge
        self.gz_topic = bridge._gz_name(row.entry.gz_topic)
        self._pair = row.pair
        self._status = row.status
        self._closed = False
        self._unreported: Counter[str] = Counter()
        self._said_at: float | None = None

    def _count(self, field: str) -> None:
        with self._bridge._status_lock:
            setattr(self._status, field, getattr(self._status, field) + 1)

    def _drop(self, ros_or_gz_type: str, topic: str, reason: str) -> None:
        fault = f"{ros_or_gz_type} on {topic} was not bridged: {reason}"
        with self._bridge._status_lock:
            self._status.dropped += 1
            self._status.last_error = fault
            self._unreported[fault] += 1
        self.say_unsaid()

    def _note(self, ros_or_gz_type: str, topic: str, remarks: list[str]) -> None:
        """Warn about what was sent on incompletely."""
        with self._bridge._status_lock:
            self._unreported.update(f"{ros_or_gz_type} on {topic} was bridged, but {text}" for text in remarks)
        self.say_unsaid()

    def say_unsaid(self, at_once: bool = False) -> None:
        """Warn about the messages lost since the last warning, at most once per second unless `at_once`."""
        with self._bridge._status_lock:
            now = self._bridge._monotonic()
            recently = self._said_at is not None and now - self._said_at < _SECONDS_BETWEEN_WARNINGS
            if not self._unreported or (recently and not at_once):
                return
            count = self._unreported.total()
            (fault, _), *others = self._unreported.most_common()
            self._unreported.clear()
            self._said_at = now
        more = f", and for {len(others)} other reasons" if len(others) > 1 else ", and another reason" if others else ""
        times = f" ({count} messages since the last such line{more})" if count > 1 else ""
        self._bridge._ros_node.get_logger().warning(f"{fault}{times}")


class GzToRos(Link):
    """The direction from Gazebo to ROS of one entry."""

    def __init__(self, bridge: Bridge, row: Row, heard_by: tuple[EchoFilter, ...]) -> None:
        super().__init__(bridge, row)
        self.subscribed = False
        self._worker: Worker | None = None
        self.publisher = bridge._ros_node.create_publisher(
            row.pair.ros_class,
            row.entry.ros_topic,
            qos(row.entry.qos_profile, row.entry.publisher_queue),
            qos_overriding_options=QoSOverridingOptions(_PUBLISHER_POLICIES),
            publisher_class=EchoAwarePublisher if heard_by else Publisher,
        )
        if heard_by:
            self.publisher.filters = heard_by

    def wanted(self) -> bool:
        """Return whether there is a ROS subscription other than that of this bridge."""
        own = sum(link.connected and link.ros_topic == self.ros_topic for link in self._bridge._to_gz)
        return bool(self.publisher.get_subscription_count() > own)

    def connect(self) -> None:
        """Subscribe in Gazebo. Raises BridgeError if `gz.transport` refuses."""
        self.connected = True
        if not self.subscribed:
            self.subscribed = True
            gz_node, topic = self._bridge._gz_node, self.entry.gz_topic
            # The bridge's own messages would be bridged back.
            options = SubscribeOptions(ignore_local_messages=True)
            if self._bridge._threaded:
                done = gz_node.subscribe_raw(topic, self._on_data, self._pair.gz_type, options)
            else:
                done = gz_node.subscribe(self._pair.gz_class, topic, self._on_message, options)
            if not done:
                raise BridgeError([sentence(self.entry, f"cannot subscribe to the Gazebo topic {topic}")])

    def disconnect(self) -> None:
        if self.connected:
            self.connected = False
            self._bridge._disconnect_gz(self.gz_topic)

    def close(self) -> None:
        """Unsubscribe and destroy the publisher; a message being bridged may still be published."""
        self.disconnect()
        if not self._closed:
            self._closed = True
            if self._worker is not None:
                self._worker.close()
            self._bridge._ros_node.destroy_publisher(self.publisher)

    def _on_data(self, data: bytes, info: MessageInfo) -> None:
        """Bridge a serialized message, in a worker if the topic carries large ones."""
        if self._worker is None and len(data) >= HEAVY_BYTES and not info.intra_process:
            self._worker = Worker(self.gz_topic, self._on_heavy, self.entry.publisher_queue, self._skipped)
        if self._worker is None or info.intra_process:
            self._on_message(self._pair.gz_class.FromString(data))
        else:
            self._worker.put(data)

    def _on_heavy(self, data: bytes) -> None:
        try:
            self._on_message(self._pair.gz_class.FromString(data))
        except Exception as error:
            self._drop(self._pair.gz_type, self.entry.gz_topic, error_text(error))

    def _skipped(self) -> None:
        with self._bridge._status_lock:
            self._status.skipped += 1
            self._unreported[
                f"{self._pair.gz_type} on {self.entry.gz_topic} was skipped: they come faster than they can be bridged"
            ] += 1
        self.say_unsaid()

    def _on_message(self, gz: Any) -> None:
        if not self.connected:
            return
        try:
            ros, remarks = converted(self._pair.to_ros, gz)
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
        self._count("gz_to_ros")
        if remarks:
            self._note(self._pair.gz_type, self.entry.gz_topic, remarks)

    def _override_header(self, ros: Any) -> None:
        header = getattr(ros, "header", None)
        if header is None:
            return
        overrides = self._bridge._overrides
        if frame_id := self.entry.frame_id or overrides.frame_id:
            header.frame_id = frame_id
        if overrides.wall_time:
            header.stamp.sec, header.stamp.nanosec = divmod(time.time_ns(), 10**9)


class RosToGz(Link):
    """The direction from ROS to Gazebo of one entry."""

    def __init__(self, bridge: Bridge, row: Row, echo_filter: EchoFilter | None) -> None:
        super().__init__(bridge, row)
        self._echo_filter = echo_filter
        self._publisher = bridge._gz_publisher(row.entry.gz_topic, row.pair)
        self.subscription: Any = None

    def wanted(self) -> bool:
        """Return whether there is a Gazebo subscriber, which a bidirectional entry has itself."""
        return bool(self._publisher.has_connections())

    def connect(self) -> None:
        if self.connected:
            return
        self.connected = True
        listener = self._bridge._listener
        # rclpy passes the stamps of the message to a callback with two parameters.
        self.subscription = self._bridge._ros_node.create_subscription(
            self._pair.ros_class,
            self.entry.ros_topic,
            self.take if self._echo_filter is None else self._on_message_with_info,
            qos(self.entry.qos_profile, self.entry.subscriber_queue),
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
            callback_group=None if listener is None else listener.group,
        )
        if listener is not None:
            listener.add(self.subscription, self._on_message_with_info, self._on_failure)

    def disconnect(self) -> None:
        self.connected = False
        if self.subscription is not None:
            if self._bridge._listener is not None:
                self._bridge._listener.remove(self.subscription)
            self._bridge._ros_node.destroy_subscription(self.subscription)
            self.subscription = None

    def close(self) -> None:
        self.disconnect()

    def _on_failure(self, error: Exception) -> None:
        self._drop(self._pair.ros_type, self.entry.ros_topic, error_text(error))

    def _on_message_with_info(self, ros: Any, info: dict[str, int]) -> None:
        if self._echo_filter is not None and self._echo_filter.is_echo(ros, info["source_timestamp"]):
            self._count("echoes")
        else:
            self.take(ros)

    def takes(self, ros_topic: str, ros: Any) -> bool:
        """Return whether messages of this type on a topic are for this link."""
        return self.ros_topic == ros_topic and isinstance(ros, self._pair.ros_class)

    def take(self, ros: Any) -> None:
        """Bridge a message from ROS."""
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
            gz, remarks = converted(pair.to_gz, ros)
        except Exception as error:
            self._drop(pair.ros_type, self.entry.ros_topic, str(error))
            return
        if self._publisher.publish(gz):
            self._count("ros_to_gz")
            self._bridge._announce(pair)
            if remarks:
                self._note(pair.ros_type, self.entry.ros_topic, remarks)
        else:
            self._drop(pair.ros_type, self.entry.ros_topic, f"gz.transport refused it on {self.entry.gz_topic}")


def error_text(error: BaseException) -> str:
    """Return the text of an error in one line, without places in ROS's C sources."""
    return re.sub(r", at /\S+:\d+", "", " ".join(str(error).split())) or type(error).__name__


def sentence(entry: BridgeEntry | ServiceEntry, text: str) -> str:
    """Return `text` after the place of the entry, if that is known."""
    return f"{entry.source}: {text}" if entry.source else text
