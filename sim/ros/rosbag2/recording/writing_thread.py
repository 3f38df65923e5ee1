"""Writes a bag in a thread, so that a slow disk does not keep the node from hearing."""

from __future__ import annotations

import threading
import time
from collections import Counter, deque

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage.bag_writer import BagWriter
from gz_course.sim.ros.rosbag2.storage.mcap_writing import DiskFullError
from gz_course.sim.ros.rosbag2.storage.metadata import Topic

FLUSH_EVERY = 1.0  # [s] after which the last messages are on the disk
_Message = tuple[str, int, int, bytes]
_NewTopic = tuple[Topic, tuple[str, str]]


class WritingThread:
    """Takes messages until `close`; those that do not fit into `cache_bytes` are lost, and counted in `lost`.

    `failure` is the sentence of the first error, such as a full disk; nothing is written after it.
    """

    def __init__(self, writer: BagWriter, cache_bytes: int) -> None:
        self.failure = ""
        self.lost: Counter[str] = Counter()
        self.writer = writer
        self._most = cache_bytes or float("inf")
        self._queue: deque[_Message | _NewTopic] = deque()
        self._waiting_bytes = 0
        self._changed = threading.Condition()
        self._closing = False
        self._splitting = False
        self._thread = threading.Thread(target=self._run, name="bag writer", daemon=True)
        self._thread.start()

    def add_topic(self, topic: Topic, definition: tuple[str, str]) -> None:
        with self._changed:
            self._queue.append((topic, definition))

    def write(self, topic: str, received: int, sent: int, data: bytes) -> None:
        """Have a serialised message written, with its times [ns]."""
        with self._changed:
            if self._waiting_bytes and self._waiting_bytes + len(data) > self._most:
                self.lost[topic] += 1
                return
            self._waiting_bytes += len(data)
            self._queue.append((topic, received, sent, data))
            self._changed.notify()

    def split(self) -> None:
        """Have the bag continued in a new file."""
        with self._changed:
            self._splitting = True
            self._changed.notify()

    def close(self) -> None:
        """Write what is waiting, and finish the bag."""
        with self._changed:
            self._closing = True
            self._changed.notify()
        self._thread.join()

    def _run(self) -> None:
        try:
            self._write_all()
            self.writer.close()
        except DiskFullError as error:
            self.writer.abandon()
            self._fail(f"{error}. Recording has stopped; what was written before can be read.")
            self._save_metadata()
        except BagError as error:
            self._fail(str(error))

    def _write_all(self) -> None:
        flushed = time.monotonic()
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._queue or self._closing or self._splitting, FLUSH_EVERY)
                batch, self._queue = self._queue, deque()
                splitting, self._splitting = self._splitting, False
                closing = self._closing
            for item in batch:
                if len(item) == 2:
                    self.writer.add_topic(*item)
                else:
                    self.writer.write(*item)
                    with self._changed:
                        self._waiting_bytes -= len(item[3])
            if splitting:
                self.writer.split()
            if closing and not batch:
                return
            if time.monotonic() - flushed >= FLUSH_EVERY:
                self.writer.flush()
                flushed = time.monotonic()

    def _fail(self, sentence: str) -> None:
        with self._changed:
            self.failure = sentence
            self._queue.clear()
            self._most = 0.0

    def _save_metadata(self) -> None:
        """Write the metadata of what is whole, if the disk takes that much."""
        from gz_course.sim.ros.rosbag2.storage.bag import reindex

        try:
            reindex(self.writer.folder)
        except (BagError, OSError):
            self.failure += f" `ros2 bag reindex {self.writer.folder}` completes it when there is space again."
