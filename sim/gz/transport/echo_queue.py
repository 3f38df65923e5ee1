"""The messages of a topic as a queue, for a program that prints them.

Callbacks run in the transport's thread, the reader in the main thread, which can be interrupted. If the reader is too
slow the queue fills up and the sockets drop messages, so that memory stays bounded.
"""

from __future__ import annotations

import contextlib
import queue
import select
import sys
import threading
import time
from types import TracebackType
from typing import NamedTuple

from gz_course.sim.gz.transport.message_info import MessageInfo
from gz_course.sim.gz.transport.node import Node

_WAITING = 1000
_LOOK_AT_READER_S = 0.25


class Arrival(NamedTuple):
    """One message."""

    data: bytes
    type_name: str
    time_ns: int
    """Time of arrival on the monotonic clock [ns]."""


class EchoQueue:
    """A context manager that subscribes to messages of every type on a topic."""

    def __init__(self, node: Node, topic: str) -> None:
        """Subscribe. Raises ValueError if the topic name is invalid."""
        node.options.qualified(topic)
        self._node, self._topic = node, topic
        self._queue: queue.Queue[Arrival] = queue.Queue(_WAITING)
        self._ended = threading.Event()
        self._stdout = select.poll()
        with contextlib.suppress(OSError, ValueError):  # standard output without a file descriptor
            self._stdout.register(sys.stdout.fileno(), 0)
        node.subscribe_raw(topic, self._keep)

    def _keep(self, data: bytes, info: MessageInfo) -> None:
        if not self._ended.is_set():
            self._queue.put(Arrival(data, info.type, time.monotonic_ns()))

    def next(self, deadline: float) -> Arrival | None:
        """Return the next message, or None at the deadline (time.monotonic() [s]).

        It may also return None earlier, so that the caller can check reader_gone().
        """
        wait = min(deadline - time.monotonic(), _LOOK_AT_READER_S)
        try:
            return self._queue.get(timeout=wait) if wait > 0 else self._queue.get_nowait()
        except queue.Empty:
            return None

    def reader_gone(self) -> bool:
        """Return whether standard output is a pipe whose reader has closed it."""
        return bool(self._stdout.poll(0))

    def __enter__(self) -> EchoQueue:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._ended.set()
        self._node.unsubscribe(self._topic)
        with contextlib.suppress(queue.Empty):
            while True:
                self._queue.get_nowait()
