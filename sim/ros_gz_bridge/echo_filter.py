"""Filters that keep a bridge from bridging its own messages back.

A bidirectional entry publishes on a ROS topic to which it also subscribes, so DDS delivers its own messages to it. In
rclpy a subscription cannot ignore its own node, and the sender of a message is unknown. `EchoFilter` therefore
recognises an echo by three properties together:

* content: the bytes that the message would become on the Gazebo side;
* time: DDS stamps a message during `publish`, so the stamp of an echo lies between the times before and after that
call (all from the system clock, rounded to 1 µs);
* number: one arrival for each publication.

Messages of other publishers therefore pass, even with the same content, because their stamps are outside of this
window. If such a message is sent within the microseconds of `publish`, it cannot be distinguished from the echo, and
one of the two passes. An echo that DDS dropped leaves a record whose window no later stamp can match.

If the system clock is set back during `publish`, one message is bridged back once; it does not circulate, because
`GzEcho` filters on the Gazebo side.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from rclpy.publisher import Publisher

_ROUNDING_NS = 1000


@dataclass(eq=False)
class _Publication:
    content: bytes
    not_before: int
    not_after: int | None = None


class EchoFilter:
    """The filter of one ROS subscription for messages published by the same bridge. Thread-safe.

    `content` converts a ROS message to the bytes that are compared. `capacity` is the maximum number of publications
    that may not have arrived yet: the sum of the depths of the publishers and of the subscription.
    """

    def __init__(self, content: Callable[[Any], bytes], capacity: int, now: Callable[[], int] = time.time_ns) -> None:
        self._content = content
        self._now = now
        self._published: deque[_Publication] = deque(maxlen=capacity)
        self._lock = threading.Lock()

    @contextlib.contextmanager
    def publishing(self, message: Any) -> Iterator[None]:
        """Record `message` around the call that hands it to DDS."""
        publication = _Publication(self._content(message), self._now() - _ROUNDING_NS)
        with self._lock:
            self._published.append(publication)
        try:
            yield
        finally:
            publication.not_after = self._now() + _ROUNDING_NS

    def is_echo(self, message: Any, source_timestamp: int) -> bool:
        """Return whether `message`, stamped by DDS at `source_timestamp` [ns since 1970], is from this bridge."""
        with self._lock:
            if not self._published:
                return False
        content = self._content(message)
        with self._lock:
            for publication in self._published:
                end = publication.not_after
                in_time = publication.not_before <= source_timestamp and (end is None or source_timestamp <= end)
                if in_time and publication.content == content:
                    self._published.remove(publication)
                    return True
        return False


class EchoAwarePublisher(Publisher):
    """A ROS publisher that records each message in echo filters when it is passed to DDS.

    The owner of the bridge may delay messages, so this can be later than their conversion. `filters` are those of the
    subscriptions on the same topic.
    """

    filters: tuple[EchoFilter, ...] = ()

    def publish(self, msg: Any) -> None:
        with contextlib.ExitStack() as stack:
            for echo_filter in self.filters:
                stack.enter_context(echo_filter.publishing(msg))
            super().publish(msg)


class GzEcho:
    """The filter for Gazebo topics within the bridge's own process, where delivery happens inside `publish`.

    While a message is being published, its content is kept for this thread; an arrival in the same thread on the same
    topic with that content is the echo. Messages of other publishers of the process pass.
    """

    def __init__(self) -> None:
        self._local = threading.local()

    def _current(self) -> list[tuple[str, bytes]]:
        if not hasattr(self._local, "current"):
            self._local.current = []
        return self._local.current

    @contextlib.contextmanager
    def publishing(self, topic: str, message: Any) -> Iterator[None]:
        """Record `message` around the call that publishes it on the Gazebo `topic`."""
        current = self._current()
        mark = (topic, message.SerializeToString())
        current.append(mark)
        try:
            yield
        finally:
            current.remove(mark)

    def is_echo(self, topic: str, message: Any) -> bool:
        """Return whether `message`, arriving on `topic` in this thread, is the one the bridge is publishing."""
        current = self._current()
        return bool(current) and (topic, message.SerializeToString()) in current
