"""Records topics: subscribes to what is chosen as it comes, and gives what it hears to a writer.

Source: rosbag2_transport 0.26 (`recorder.cpp`): what is said, which topics are taken, the times of a message
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, cast

from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

from gz_course.sim.ros.rosbag2.definitions import definition
from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.qos import request_for, stored
from gz_course.sim.ros.rosbag2.recording.snapshot import SnapshotThread
from gz_course.sim.ros.rosbag2.recording.writing_thread import WritingThread
from gz_course.sim.ros.rosbag2.selection import SERVICE_EVENTS, Selection, is_hidden
from gz_course.sim.ros.rosbag2.storage.metadata import Topic

_AT_ONCE = 200  # messages of one topic that are taken before others have their turn


@dataclass(frozen=True)
class RecordOptions:
    """What is recorded, and how."""

    selection: Selection
    hidden: bool = False
    unpublished: bool = False
    ignore_leaf: bool = False
    sim_time: bool = False
    overrides: dict[str, Any] = field(default_factory=dict)


class Recorder:
    """Records with a node, which its user spins; `message_class` finds the class of a type or raises BagError."""

    def __init__(
        self, node: Any, writing: WritingThread, options: RecordOptions, message_class: Callable[[str], Any]
    ) -> None:
        self.paused = False
        self._node = node
        self._writing = writing
        self._options = options
        self._message_class = message_class
        self._subscriptions: dict[str, Any] = {}
        self._refused: set[str] = set()
        self._own = node.get_fully_qualified_name()

    def look(self) -> None:
        """Subscribe to chosen topics that are new; adapt to publishers that are new."""
        for name, types in self._node.get_topic_names_and_types():
            if name in self._refused:
                continue
            if name in self._subscriptions:
                self._adapt(name)
            elif self._is_chosen(name, types):
                self._begin(name, types)

    def topics(self) -> list[str]:
        """Return the topics that are recorded."""
        return sorted(self._subscriptions)

    def pause(self) -> None:
        if not self.paused:
            self._node.get_logger().info("Pausing recording.")
        self.paused = True

    def resume(self) -> None:
        if self.paused:
            self._node.get_logger().info("Resuming recording.")
        self.paused = False

    def toggle(self) -> None:
        if self.paused:
            self.resume()
        else:
            self.pause()

    def split(self) -> None:
        self._writing.split()

    def on_split(self, tell: Callable[[str, str], object]) -> None:
        """Have a function called with the paths of the file that has ended and of the new one, in another thread."""
        self._writing.writer.on_split = tell

    @property
    def can_snapshot(self) -> bool:
        """Return whether messages are kept in memory until somebody asks for them."""
        return isinstance(self._writing, SnapshotThread)

    def snapshot(self) -> bool:
        """Have what is kept in memory written; return whether that is possible."""
        return isinstance(self._writing, SnapshotThread) and self._writing.snapshot()

    def take_the_rest(self) -> None:
        """Take what has arrived and is not taken yet, and stop hearing."""
        for subscription in self._subscriptions.values():
            while self._take(subscription):
                pass
            self._node.destroy_subscription(subscription)
        self._subscriptions = {}

    def _is_chosen(self, name: str, types: list[str]) -> bool:
        options = self._options
        if not any(options.selection.takes(name, each) for each in types):
            return False
        named = name in options.selection.topics
        if is_hidden(name) and not options.hidden and not named and not name.endswith(SERVICE_EVENTS):
            return False
        if not options.unpublished and not self._publishers(name):
            return False
        return not options.ignore_leaf or self._node.count_subscribers(name) > 0

    def _publishers(self, name: str) -> list[Any]:
        return cast(list[Any], self._node.get_publishers_info_by_topic(name))

    def _begin(self, name: str, types: list[str]) -> None:
        if len(types) > 1:
            self._refuse(name, f"Topic '{name}' has several types associated: {', '.join(types)}. It is not recorded.")
            return
        try:
            kind = self._message_class(types[0])
        except BagError as error:
            self._refuse(name, f"Topic '{name}' is not recorded: {error}")
            return
        publishers = self._publishers(name)
        hashes = [str(each.topic_type_hash) for each in publishers]
        topic = Topic(
            name,
            types[0],
            qos=tuple(stored(each.qos_profile) for each in publishers),
            type_hash=next((each for each in hashes if each.startswith("RIHS")), ""),
        )
        self._writing.add_topic(topic, definition(types[0]))
        self._subscribe(name, kind, publishers)
        self._node.get_logger().info(f"Subscribed to topic '{name}'")

    def _refuse(self, name: str, sentence: str) -> None:
        self._refused.add(name)
        self._node.get_logger().warning(sentence)

    def _subscribe(self, name: str, kind: Any, publishers: list[Any]) -> None:
        request, warning = request_for(publishers)
        if (override := self._options.overrides.get(name)) is not None:
            request, warning = override, ""
        if warning:
            self._node.get_logger().warning(f"Topic '{name}': {warning}.")

        def heard(data: bytes, info: dict[str, int]) -> None:
            self._keep(name, data, info)
            for _ in range(_AT_ONCE):
                if not self._take(self._subscriptions.get(name)):
                    break

        self._subscriptions[name] = self._node.create_subscription(kind, name, heard, request, raw=True)

    def _take(self, subscription: Any) -> bool:
        """Take a message without waiting for the executor; return whether there was one."""
        if subscription is None:
            return False
        with subscription.handle:
            taken = subscription.handle.take_message(subscription.msg_type, True)
        if taken is None:
            return False
        self._keep(subscription.topic_name, *taken)
        return True

    def _keep(self, name: str, data: bytes, info: dict[str, int]) -> None:
        if self.paused:
            return
        received, sent = info["received_timestamp"] or time.time_ns(), info["source_timestamp"]
        if self._options.sim_time:
            received = self._node.get_clock().now().nanoseconds
            if not received:  # no /clock yet
                return
        self._writing.write(name, received, max(0, sent), data)

    def _adapt(self, name: str) -> None:
        """Subscribe again if a new publisher would not be heard."""
        if name in self._options.overrides:
            return
        publishers = self._publishers(name)
        have, need = self._subscriptions[name].qos_profile, request_for(publishers)[0]
        weaker = (
            have.reliability == ReliabilityPolicy.RELIABLE and need.reliability != ReliabilityPolicy.RELIABLE
        ) or (
            have.durability == DurabilityPolicy.TRANSIENT_LOCAL and need.durability != DurabilityPolicy.TRANSIENT_LOCAL
        )
        if publishers and weaker:
            before = self._subscriptions.pop(name)
            while self._take(before):
                pass
            self._node.destroy_subscription(before)
            self._subscribe(name, before.msg_type, publishers)
