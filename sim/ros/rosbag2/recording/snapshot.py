"""Recording into memory: the last messages, which are written when somebody asks for a snapshot.

Source: rosbag2_cpp 0.26 (`circular_message_cache.cpp`)
"""

from __future__ import annotations

from collections import deque

from gz_course.sim.ros.rosbag2.recording.writing_thread import WritingThread
from gz_course.sim.ros.rosbag2.storage.bag_writer import BagWriter


class SnapshotThread(WritingThread):
    """Keeps the last messages, `cache_bytes` of them, and writes them at `snapshot`; what is older is dropped."""

    def __init__(self, writer: BagWriter, cache_bytes: int) -> None:
        super().__init__(writer, 0)
        self._kept: deque[tuple[str, int, int, bytes]] = deque()
        self._kept_bytes = 0
        self._most_kept = cache_bytes

    def write(self, topic: str, received: int, sent: int, data: bytes) -> None:
        with self._changed:
            self._kept.append((topic, received, sent, data))
            self._kept_bytes += len(data)
            while self._kept_bytes > self._most_kept:
                self._kept_bytes -= len(self._kept.popleft()[3])

    def snapshot(self) -> bool:
        """Have the kept messages written; return False if nothing can be written any more."""
        with self._changed:
            if self.failure:
                return False
            self._queue.extend(self._kept)
            self._waiting_bytes += self._kept_bytes
            self._kept.clear()
            self._kept_bytes = 0
            self._changed.notify()
            return True
