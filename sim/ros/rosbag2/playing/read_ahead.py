"""Reads messages of a bag before they are due, so that playing does not wait for the disk."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterator

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage.mcap_reading import Message

MOST_BYTES = 64 * 1024 * 1024


class ReadAhead:
    """An iterator over messages that a thread reads; at most `count` of them wait. Used with `with`."""

    def __init__(self, messages: Iterator[Message], count: int) -> None:
        self._messages = messages
        self._count = max(1, count)
        self._waiting: deque[Message] = deque()
        self._bytes = 0
        self._changed = threading.Condition()
        self._ended = self._closed = False
        self._failure = ""
        self._thread = threading.Thread(target=self._read, name="bag reader", daemon=True)

    def __enter__(self) -> ReadAhead:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        self._thread.join()

    def __iter__(self) -> Iterator[Message]:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._waiting or self._ended)
                if not self._waiting:
                    if self._failure:
                        raise BagError(self._failure)
                    return
                message = self._waiting.popleft()
                self._bytes -= len(message.data)
                self._changed.notify_all()
            yield message

    def _read(self) -> None:
        try:
            for message in self._messages:
                with self._changed:
                    self._changed.wait_for(self._has_room)
                    if self._closed:
                        return
                    self._waiting.append(message)
                    self._bytes += len(message.data)
                    self._changed.notify_all()
        except (BagError, OSError) as error:
            self._failure = str(error)
        finally:
            with self._changed:
                self._ended = True
                self._changed.notify_all()

    def _has_room(self) -> bool:
        return self._closed or (len(self._waiting) < self._count and self._bytes < MOST_BYTES)
