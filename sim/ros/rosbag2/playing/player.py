"""Plays a bag: publishes its messages as they are stored, at the spacing in which they were recorded.

Source: rosbag2_transport 0.26 (`player.cpp`, `time_controller_clock.cpp`)
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from rclpy.duration import Duration
from rclpy.qos import ReliabilityPolicy
from rosgraph_msgs.msg import Clock

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.playing.playback_clock import PlaybackClock
from gz_course.sim.ros.rosbag2.playing.read_ahead import ReadAhead
from gz_course.sim.ros.rosbag2.playing.service_requests import ServiceRequests
from gz_course.sim.ros.rosbag2.qos import to_offer
from gz_course.sim.ros.rosbag2.selection import SERVICE_EVENTS, Selection
from gz_course.sim.ros.rosbag2.storage.bag import Bag
from gz_course.sim.ros.rosbag2.storage.mcap_reading import Message
from gz_course.sim.ros.rosbag2.storage.offered_qos import offer_like
from gz_course.sim.ros.rosbag2.stored_types import installed_hash, service_class

_LONGEST_WAIT = 0.5  # [s] at a time, so that an interruption is not missed
_ACKNOWLEDGED = 1.0  # [s] for the last messages to arrive
_STEP_PATIENCE = 10.0  # [s] for a message to be played on request
_CLOCK = "/clock"


@dataclass(frozen=True)
class PlayOptions:
    """How a bag is played; times [ns], `clock_hz` 0 is no `/clock`."""

    selection: Selection = field(default_factory=lambda: Selection(all=True))
    rate: float = 1.0
    loop: bool = False
    delay: float = 0.0
    start_offset: int = 0
    duration: int = 0
    until: int = 0
    clock_hz: float = 0.0
    clock_at: Selection = field(default_factory=Selection)
    paused: bool = False
    read_ahead: int = 1000
    remapped: Mapping[str, str] = field(default_factory=dict)
    overrides: Mapping[str, Any] = field(default_factory=dict)
    acknowledged: float | None = None
    requests_of: str = ""
    """Whose events of services are sent as requests (`SOURCES`); otherwise events are published as they are."""


class Player:
    """Plays with a node; the methods but `play` are for other threads. `message_class` finds the class of a type."""

    def __init__(self, node: Any, bag: Bag, options: PlayOptions, message_class: Callable[[str], Any]) -> None:
        self._node = node
        self._bag = bag
        self._options = options
        self._changed = threading.Condition()
        self._begin = bag.start + options.start_offset
        self._clock = PlaybackClock(self._begin, options.rate, options.paused)
        ends = (bag.end, options.until, options.duration and self._begin + options.duration)
        self._end = min((end for end in ends if end > 0), default=0)
        self._seek: int | None = None
        self._steps = 0
        self._published = 0
        self._stopped = False
        self._publishers: dict[str, Any] = {}
        self._requests: dict[str, ServiceRequests] = {}
        self._clock_publisher: Any = None
        self._make_publishers(message_class)

    def topics(self) -> list[str]:
        """Return the topics of the bag that are played."""
        return sorted([*self._publishers, *self._requests])

    def play(self) -> None:
        """Play to the end, or until `stop`. Raises BagError if the bag cannot be read on."""
        ticking = threading.Thread(target=self._tick, name="clock", daemon=True)
        try:
            while self._wait_for_delay():
                if self._options.clock_hz and ticking.ident is None:
                    ticking.start()  # not before the time of the bag runs
                self._play_through()
                if self._stopped or not self._options.loop:
                    break
                self._jump(self._begin)
            self._wait_for_acknowledgment()
        finally:
            self.stop()
            if ticking.is_alive():
                ticking.join()

    def stop(self) -> None:
        with self._changed:
            self._stopped = True
            self._changed.notify_all()

    @property
    def paused(self) -> bool:
        return self._clock.paused

    @property
    def rate(self) -> float:
        return self._clock.rate

    def set_paused(self, paused: bool) -> None:
        with self._changed:
            if paused != self._clock.paused:
                self._node.get_logger().info("Pausing play." if paused else "Resuming play.")
            self._clock.set_paused(paused)
            self._changed.notify_all()

    def toggle(self) -> None:
        self.set_paused(not self.paused)

    def set_rate(self, rate: float) -> bool:
        """Change the rate; return whether it is one."""
        if not 0.0 < rate < float("inf"):
            self._node.get_logger().warning("Failed to set rate to invalid value " + str(rate))
            return False
        with self._changed:
            self._clock.set_rate(rate)
            self._changed.notify_all()
        self._node.get_logger().info(f"Set rate to {rate:g}")
        return True

    def play_again(self) -> bool:
        """Return False: the node lives as long as its bag is played, and so is always playing when it is asked."""
        self._node.get_logger().warning("Trying to play rosbag while in playback, dismissing request.")
        return False

    def play_next(self, count: int = 1) -> int:
        """Play the next messages at once if playing is paused; return how many were played. 0: all that is left."""
        with self._changed:
            if not self._clock.paused:
                self._node.get_logger().warning("Called play next, but not in paused state.")
                return 0
            before = seen = self._published
            self._steps = count or 2**62
            self._changed.notify_all()
            while not self._changed.wait_for(lambda: self._steps <= 0 or self._stopped, _STEP_PATIENCE):
                if self._published == seen:  # nothing is left, or subscribers hold it up
                    self._steps = 0
                    break
                seen = self._published
            return self._published - before

    def seek(self, bag: int) -> bool:
        """Continue at a time of the bag [ns]; return whether the bag has it."""
        if not self._begin <= bag <= self._end or self._stopped:
            return False
        with self._changed:
            self._seek = bag
            self._clock.jump(bag)
            self._changed.notify_all()
        return True

    def _make_publishers(self, message_class: Callable[[str], Any]) -> None:
        options = self._options
        for name, topic in sorted(self._bag.topics.items()):
            target = options.remapped.get(name, name)
            if not options.selection.takes(name, topic.type):
                continue
            if options.clock_hz and target == _CLOCK:
                self._warn(f"'{name}' of the bag is not played, because --clock publishes it")
                continue
            if topic.serialization_format != "cdr":
                self._warn(f"'{name}' is not played: its messages are in '{topic.serialization_format}', not in 'cdr'")
                continue
            try:
                if options.requests_of and name.endswith(SERVICE_EVENTS):
                    service = service_class(topic.type)
                    self._requests[name] = ServiceRequests(self._node, target, service, options.requests_of)
                    continue
                kind = message_class(topic.type)
            except BagError as error:
                self._warn(f"Ignoring a topic '{name}', reason: {error}")
                continue
            here = installed_hash(topic.type)
            if here and topic.type_hash.startswith("RIHS01_") and topic.type_hash != here:
                self._warn(
                    f"'{name}' was recorded with another definition of {topic.type} than the one installed here: "
                    "nodes may read wrong values"
                )
            profile, agreed = offer_like(topic.qos)
            if not agreed:
                self._warn(f"Not all original publishers on topic {name} offered the same QoS; the default is offered")
            qos = options.overrides.get(name) or to_offer(profile)
            self._publishers[name] = self._publisher(kind, name, target, qos)
        if options.clock_hz or options.clock_at.all or options.clock_at.topics:
            self._clock_publisher = self._node.create_publisher(Clock, _CLOCK, 10)

    def _publisher(self, kind: Any, name: str, target: str, qos: Any) -> Any:
        """Return a publisher for a topic of the bag. Raises BagError for a name that ROS does not allow."""
        from rclpy.exceptions import InvalidTopicNameException

        try:
            return self._node.create_publisher(kind, target, qos)
        except InvalidTopicNameException:
            remapped = f" (remapped to {target!r})" if target != name else ""
            raise BagError(
                f"{self._bag.path}: the topic {name!r}{remapped} has no name that ROS allows: letters, digits and _ in "
                "parts between single slashes, none of which begins with a digit; leave it out with --exclude-topics, "
                "or rename it with --remap"
            ) from None

    def _warn(self, sentence: str) -> None:
        self._node.get_logger().warning(sentence)

    def _play_through(self) -> None:
        begin = self._begin
        while True:
            with ReadAhead(self._bag.messages(self.topics(), begin), self._options.read_ahead) as messages:
                for message in messages:
                    if message.received > self._end or not self._wait_for(message):
                        break
                    self._publish(message)
            with self._changed:
                self._steps = 0
                self._changed.notify_all()
                if self._seek is None or self._stopped:
                    return
                begin, self._seek = self._seek, None

    def _wait_for(self, message: Message) -> bool:
        """Wait until a message is due; return False if another place was sought, or playing ends."""
        with self._changed:
            while not self._stopped and self._seek is None:
                if self._clock.paused and self._steps > 0:
                    self._clock.jump(message.received)
                    return True
                left = _LONGEST_WAIT if self._clock.paused else self._clock.until(message.received)
                if left <= 0:
                    return True
                self._changed.wait(min(left, _LONGEST_WAIT))
            return False

    def _publish(self, message: Message) -> None:
        topic = message.topic
        if self._clock_publisher is not None and self._options.clock_at.takes(topic, ""):
            self._publish_time(message.received)
        try:
            (self._publishers.get(topic) or self._requests[topic]).publish(message.data)
        except (RuntimeError, ValueError, TypeError) as error:
            raise BagError(f"a message of '{topic}' cannot be published: {str(error).splitlines()[0]}") from None
        with self._changed:
            self._published += 1
            if self._steps > 0:
                self._steps -= 1
                self._changed.notify_all()

    def _jump(self, bag: int) -> None:
        with self._changed:
            self._clock.jump(bag)

    def _wait_for_delay(self) -> bool:
        """Wait for the delay before each round; return False if playing ends meanwhile."""
        end = time.monotonic() + self._options.delay
        with self._changed:
            while not self._stopped and (left := end - time.monotonic()) > 0:
                self._changed.wait(min(left, _LONGEST_WAIT))
            self._clock.jump(self._begin)
            return not self._stopped

    def _wait_for_acknowledgment(self) -> None:
        """Wait until reliable subscribers have the last messages, and services have answered."""
        patience = _ACKNOWLEDGED if self._options.acknowledged is None else self._options.acknowledged
        for publisher in self._publishers.values():
            if publisher.qos_profile.reliability == ReliabilityPolicy.RELIABLE and not self._stopped:
                publisher.wait_for_all_acked(Duration(seconds=patience) if patience else Duration(seconds=2**31))
        for requests in self._requests.values():
            requests.wait(patience or _ACKNOWLEDGED)

    def _tick(self) -> None:
        """Publish `/clock` at its rate; the time stands still while playing is paused."""
        period = 1.0 / self._options.clock_hz
        due = time.monotonic()
        while True:
            with self._changed:
                if self._stopped:
                    return
                now = min(self._clock.now(), self._end)
            self._publish_time(now)
            due = max(due + period, time.monotonic())
            with self._changed:
                self._changed.wait_for(lambda: self._stopped, max(0.0, due - time.monotonic()))

    def _publish_time(self, now: int) -> None:
        message = Clock()
        message.clock.sec, message.clock.nanosec = divmod(max(0, min(now, 2**31 * 10**9 - 1)), 10**9)
        self._clock_publisher.publish(message)
