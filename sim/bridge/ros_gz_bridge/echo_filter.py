"""The filter that keeps a bridge from bridging its own ROS messages back.

A bidirectional entry publishes on a ROS topic to which it also subscribes, so DDS delivers its own messages to it. In
rclpy a subscription cannot ignore its own node, and the sender of a message is unknown. `EchoFilter` therefore
recognises an echo by three properties together:

* content: the bytes that the message would become on the Gazebo side. Those of a message sent are taken from what DDS
will deliver: it rounds numbers to float32 where the type of the message says so, and ends a text at its first null
character;
* time: DDS stamps a message during `publish`, so the stamp of an echo lies between the times before and after that
call (all from the system clock, rounded to 1 µs);
* number: one arrival for each publication.

Messages of other publishers therefore pass, even with the same content, because their stamps are outside of this
window. If such a message is sent within the microseconds of `publish`, it cannot be distinguished from the echo, and
one of the two passes. An echo that DDS dropped leaves a record whose window no later stamp can match.

If the system clock is set back during `publish`, one message is bridged back once; it does not circulate, because on
the Gazebo side a bridge does not hear its own node (`link.GzToRos`).
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
from rclpy.serialization import deserialize_message, serialize_message

_ROUNDING_NS = 1000


@dataclass(eq=False)
class _Publication:
    content: bytes
    not_before: int
    not_after: int | None = None


class EchoFilter:
    """The filter of one ROS subscription for messages published by the same bridge. Thread-safe.

    `content` converts a ROS message that has arrived to the bytes that are compared, `sent_content` one before it is
    sent. `capacity` is the maximum number of publications that may not have arrived yet: the sum of the depths of the
    publishers and of the subscription.
    """

    def __init__(
        self,
        content: Callable[[Any], bytes],
        sent_content: Callable[[Any], bytes],
        capacity: int,
        now: Callable[[], int] = time.time_ns,
    ) -> None:
        self._content = content
        self._sent_content = sent_content
        self._now = now
        self._published: deque[_Publication] = deque(maxlen=capacity)
        self._lock = threading.Lock()

    @contextlib.contextmanager
    def publishing(self, message: Any) -> Iterator[None]:
        """Record `message` around the call that hands it to DDS."""
        publication = _Publication(self._sent_content(message), self._now() - _ROUNDING_NS)
        with self._lock:
            self._published.append(publication)
        try:
            yield
        finally:
            publication.not_after = self._now() + _ROUNDING_NS

    def is_echo(self, message: Any, source_timestamp: int) -> bool:
        """Return whether `message`, stamped by DDS at `source_timestamp` [ns since 1970], is from this bridge."""
        with self._lock:
            in_time = [each for each in self._published if _sent_at(each, source_timestamp)]
        if not in_time:
            return False
        content = self._content(message)
        with self._lock:
            for publication in in_time:
                if publication.content == content and publication in self._published:
                    self._published.remove(publication)
                    return True
        return False


def _sent_at(publication: _Publication, stamp: int) -> bool:
    """Return whether DDS may have stamped a publication with `stamp` [ns]."""
    end = publication.not_after
    return publication.not_before <= stamp and (end is None or stamp <= end)


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


def delivered(message: Any) -> Any:
    """Return the ROS message as a subscriber gets it."""
    return deserialize_message(serialize_message(message), type(message))
