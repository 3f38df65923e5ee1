"""Keeps a bridge from hearing itself: the echo of a message it published is not bridged back.

A bidirectional entry publishes on a ROS topic it also subscribes to, so DDS hands it its own messages. rclpy
neither lets a subscription ignore its own node nor says who sent a message, so ``EchoFilter`` recognises the
echo by three things together:

* content: what the message would become on the Gazebo side, byte for byte;
* time: DDS stamps a message while ``publish`` runs, so the stamp of an echo lies between the moment just
  before and the moment just after that call (both read from the same system clock, here with 1 µs of
  rounding);
* number: every publication excuses one arrival and no more.

So genuine messages pass, however often they repeat. One sent a moment earlier or later than our own, even
with the same content, carries a stamp outside the window. One sent by somebody else within the very
microseconds of ``publish`` and with the same content cannot be told from the echo, nor needs to be: one of
the two passes, and the two are equal. An echo that DDS dropped leaves its record behind, whose window no
later stamp can fall into.

The worst that can happen is the opposite, one message bridged back once (when the system clock is set back
during ``publish``); it cannot circulate, because ``GzEcho`` does the same on the Gazebo side.
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
    """Recognises, for one ROS subscription, the messages published by the same bridge.

    ``content`` turns a ROS message into the bytes compared. ``capacity`` is how many publications may still
    be on their way: the depths of the publishers and of the subscription, whatever lies further back can no
    longer arrive. Thread safe: publishing and receiving happen in different threads.
    """

    def __init__(self, content: Callable[[Any], bytes], capacity: int, now: Callable[[], int] = time.time_ns) -> None:
        self._content = content
        self._now = now
        self._published: deque[_Publication] = deque(maxlen=capacity)
        self._lock = threading.Lock()

    @contextlib.contextmanager
    def publishing(self, message: Any) -> Iterator[None]:
        """Wrap the very call that hands ``message`` to DDS."""
        publication = _Publication(self._content(message), self._now() - _ROUNDING_NS)
        with self._lock:
            self._published.append(publication)
        try:
            yield
        finally:
            publication.not_after = self._now() + _ROUNDING_NS

    def is_echo(self, message: Any, source_timestamp: int) -> bool:
        """Whether ``message``, stamped by DDS at ``source_timestamp`` (ns since 1970), is one of our own."""
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
    """A ROS publisher that tells echo filters the moment a message really leaves.

    The owner of the bridge may hold messages back and release them later, so the moment is taken here and not
    where the bridge decides to publish. ``filters`` are those of the subscriptions on the same topic.
    """

    filters: tuple[EchoFilter, ...] = ()

    def publish(self, msg: Any) -> None:
        """Publish ``msg``, noting it in every filter."""
        with contextlib.ExitStack() as stack:
            for echo_filter in self.filters:
                stack.enter_context(echo_filter.publishing(msg))
            super().publish(msg)


class GzEcho:
    """The same for Gazebo topics of the bridge's own process, where delivery happens inside ``publish``.

    While a message is being published, its content is remembered for this thread; an arrival in the same
    thread on the same topic with that content is the echo. Other publishers of the process are heard,
    whatever they send.
    """

    def __init__(self) -> None:
        self._local = threading.local()

    def _current(self) -> list[tuple[str, bytes]]:
        if not hasattr(self._local, "current"):
            self._local.current = []
        return self._local.current

    @contextlib.contextmanager
    def publishing(self, topic: str, message: Any) -> Iterator[None]:
        """Wrap the call that publishes ``message`` on the Gazebo ``topic``."""
        current = self._current()
        mark = (topic, message.SerializeToString())
        current.append(mark)
        try:
            yield
        finally:
            current.remove(mark)

    def is_echo(self, topic: str, message: Any) -> bool:
        """Whether ``message``, arriving on ``topic`` in this thread, is the one the bridge is publishing."""
        current = self._current()
        return bool(current) and (topic, message.SerializeToString()) in current
