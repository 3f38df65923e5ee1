"""The running bridge: takes messages from one side, converts them and publishes them on the other.

It connects a ROS node and a Gazebo node that its owner spins. ROS messages arrive in the executor's thread or in that
of a `RosListener`, Gazebo messages in the thread that delivers them (the publisher's, or the dispatcher of
`gz.transport`). Commands that are not finite numbers are dropped here, before they reach the simulator.
"""

from __future__ import annotations

import dataclasses
import threading
import time
from collections.abc import Callable, Iterable
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node as RosNode
from rclpy.publisher import Publisher
from rclpy.timer import Timer

from gz_course.sim.bridge.ros_gz_bridge.echo_filter import EchoFilter, delivered
from gz_course.sim.bridge.ros_gz_bridge.entry import (
    BridgeEntry,
    BridgeError,
    EntryStatus,
    HeaderOverrides,
    ServiceEntry,
)
from gz_course.sim.bridge.ros_gz_bridge.link import GzToRos, RosToGz, Row, error_text, sentence
from gz_course.sim.bridge.ros_gz_bridge.ros_listener import RosListener
from gz_course.sim.bridge.ros_gz_bridge.service_link import ServiceLink
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import TypePair, UnknownPairError, find_pair, find_service
from gz_course.sim.gz.transport import AdvertiseMessageOptions, naming
from gz_course.sim.gz.transport import Node as GzNode

LeftOut = Callable[[BridgeEntry | ServiceEntry, str], None]
_ECHO_MARGIN = 16


class Bridge:
    """A bridge of `entries` and `services` between `ros_node` and `gz_node`, until `close`.

    Give it a Gazebo node of its own: closing drops every subscription that node has on the bridged topics. The ROS node
    may have other endpoints; its owner must spin it.

    - `publish(publisher, message)` is called for each message to ROS and may publish it later; by default at once.
    - `heard(entry, message)` is called for every message from ROS, before it is checked and converted.
    - `heartbeat` [s] is the period in which lazy entries look for subscribers.
    - `threaded` gives each topic with large messages from other processes a thread, and all topics from ROS another;
      without it a message is bridged in the thread that delivers it.
    - `monotonic` returns the time [s] by which warnings are limited.
    - `left_out(entry, sentence)` is called for each entry that ROS or Gazebo refuses, for instance because a topic was
      renamed to one of another type; without it such an entry is an error.

    Raises BridgeError listing every entry that cannot work, and then leaves nothing behind.
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
        services: Iterable[ServiceEntry] = (),
        threaded: bool = False,
        monotonic: Callable[[], float] = time.monotonic,
        left_out: LeftOut | None = None,
    ) -> None:
        self.entries = list(entries)
        self.services = list(services)
        self._threaded = threaded
        self._listener = RosListener(ros_node.context) if threaded else None
        self._monotonic = monotonic
        self._ros_node = ros_node
        self._gz_node = gz_node
        self._publish = publish or _publish_now
        self._heard = heard
        self._overrides = overrides or HeaderOverrides()
        self._announced: set[tuple[str, str]] = set()
        self._to_ros: list[GzToRos] = []
        self._to_gz: list[RosToGz] = []
        self._offered: list[ServiceLink] = []
        self._gz_publishers: dict[str, Any] = {}
        self._timer: Timer | None = None
        self._status = [EntryStatus(entry) for entry in self.entries]
        self._status_lock = threading.Lock()
        rows = self._checked()
        try:
            self._set_up(rows, left_out)
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
        """Return a copy of the counters of every entry, in the order of `entries`. Thread-safe."""
        with self._status_lock:
            return [dataclasses.replace(status) for status in self._status]

    def take(self, ros_topic: str, message: Any) -> bool:
        """Bridge a message as if it had come on a ROS topic; return whether an entry takes its type there."""
        links = [each for each in self._to_gz if each.takes(ros_topic, message)]
        for link in links:
            link.take(message)
        return bool(links)

    def close(self) -> None:
        """Destroy all publishers, subscriptions and timers; the counters remain. Closing twice does nothing."""
        if self._timer is not None:
            self._ros_node.destroy_timer(self._timer)
            self._timer = None
        for service in self._offered:
            service.close()
        self.say_unsaid(at_once=True)
        for incoming in self._to_ros:
            incoming.close()
        for outgoing in self._to_gz:
            outgoing.close()
        if self._listener is not None:
            self._listener.close()
        for publisher in self._gz_publishers.values():
            publisher.close()
        self._gz_publishers.clear()

    def say_unsaid(self, at_once: bool = False) -> None:
        """Log losses that have not been reported yet; the owner calls it periodically."""
        for link in self._links():
            link.say_unsaid(at_once)

    def _checked(self) -> list[Row]:
        """Return every entry with its pair and its ROS topic after remapping. Raises BridgeError."""
        rows, errors = [], []
        for entry, status in zip(self.entries, self._status, strict=True):
            try:
                pair = find_pair(entry.ros_type, entry.gz_type)
                rows.append(Row(entry, status, pair, self._ros_node.resolve_topic_name(entry.ros_topic)))
            except UnknownPairError as error:
                errors.append(sentence(entry, str(error)))
            except Exception as error:
                errors.append(sentence(entry, f"cannot bridge {entry.ros_topic}: {error_text(error)}"))
        for service in self.services:
            try:
                find_service(service.ros_type, service.gz_request_type, service.gz_reply_type)
            except UnknownPairError as error:
                errors.append(sentence(service, str(error)))
        if errors:
            raise BridgeError(errors)
        return rows

    def _set_up(self, rows: list[Row], left_out: LeftOut | None) -> None:
        """Create every endpoint, publishers first, so that no message arrives before it can be published."""
        filters = _echo_filters(rows)
        errors: list[tuple[BridgeEntry | ServiceEntry, str]] = []
        for row in rows:
            try:
                if row.entry.direction.to_ros:
                    heard_by = tuple(own for other, own in filters if other.ros_topic == row.ros_topic)
                    self._to_ros.append(GzToRos(self, row, heard_by))
                if row.entry.direction.to_gz:
                    own_filter = next((own for other, own in filters if other is row), None)
                    self._to_gz.append(RosToGz(self, row, own_filter))
            except Exception as error:
                errors.append((row.entry, f"cannot bridge {row.entry.ros_topic}: {error_text(error)}"))
        for service in self.services:
            try:
                self._offered.append(ServiceLink(self._ros_node, self._gz_node, service))
            except Exception as error:
                errors.append((service, f"cannot offer {service.name}: {error_text(error)}"))
        if left_out is not None:
            for entry, text in errors:
                left_out(entry, sentence(entry, text))
        elif errors:
            raise BridgeError([sentence(entry, text) for entry, text in errors])
        for link in self._links():
            if not link.entry.lazy:
                link.connect()

    def _links(self) -> list[GzToRos | RosToGz]:
        return [*self._to_ros, *self._to_gz]

    def _connect_lazy(self) -> None:
        for link in self._links():
            if link.entry.lazy:
                if link.wanted():
                    link.connect()
                else:
                    link.disconnect()

    def _gz_name(self, topic: str) -> str:
        """Return the Gazebo topic with namespace and remapping of the node applied."""
        options = self._gz_node.options
        return naming.split(naming.fully_qualified("", options.namespace, options.renamed(topic)))[1]

    def _gz_publisher(self, topic: str, pair: TypePair) -> Any:
        """Return the one Gazebo publisher of a topic, which several entries may share."""
        name = self._gz_name(topic)
        publisher = self._gz_publishers.get(name)
        if publisher is None:
            publisher = self._gz_node.advertise(topic, pair.gz_class, AdvertiseMessageOptions())
            if not publisher.valid():
                raise ValueError(f"gz.transport does not advertise the topic {topic!r}")
            self._gz_publishers[name] = publisher
        elif publisher.type_name != pair.gz_type:
            raise ValueError(f"the Gazebo topic {topic} carries {publisher.type_name} already, not {pair.gz_type}")
        return publisher

    def _disconnect_gz(self, topic: str) -> None:
        """Unsubscribe from a Gazebo topic when no entry listens to it; this ends all subscriptions of the topic."""
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
                f"Passing message from ROS {pair.ros_type} to Gazebo {pair.gz_type} (showing msg only once per type)"
            )


def _publish_now(publisher: Publisher, message: Any) -> None:
    publisher.publish(message)


def _echo_filters(rows: list[Row]) -> list[tuple[Row, EchoFilter]]:
    """Return a filter for every entry that subscribes to a ROS topic which one of the entries publishes."""
    depths: dict[str, int] = {}
    for row in rows:
        if row.entry.direction.to_ros:
            depths[row.ros_topic] = depths.get(row.ros_topic, 0) + row.entry.publisher_queue
    listening = [row for row in rows if row.entry.direction.to_gz and row.ros_topic in depths]
    filters = []
    for row in listening:
        arrived, sent = contents(row.pair)
        capacity = depths[row.ros_topic] + row.entry.subscriber_queue + _ECHO_MARGIN
        filters.append((row, EchoFilter(arrived, sent, capacity)))
    return filters


def contents(pair: TypePair) -> tuple[Callable[[Any], bytes], Callable[[Any], bytes]]:
    """Return what an echo filter compares, the bytes for Gazebo: of a message that arrived, and of one to be sent."""

    def arrived(ros: Any) -> bytes:
        try:
            return bytes(pair.to_gz(ros).SerializeToString(deterministic=True))
        except Exception:  # such messages are dropped and need not be distinguished
            return b""

    return arrived, lambda ros: arrived(delivered(ros))
