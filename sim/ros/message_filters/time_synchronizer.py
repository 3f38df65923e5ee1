"""The filter that waits for one message of each input with the same stamp."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import Any

from rclpy.time import Time

from gz_course.sim.ros.message_filters.simple_filter import SimpleFilter


class TimeSynchronizer(SimpleFilter):
    """Sets of messages with equal stamps, one of each filter in `fs`; the callback gets one message for each.

    Of each input, the `queue_size` messages with the latest stamps are kept (`queues`: stamp [ns] -> message).
    Messages older than a complete set are dropped. A message must have a header.
    """

    def __init__(self, fs: Sequence[SimpleFilter], queue_size: int) -> None:
        super().__init__()
        self.queue_size = queue_size
        self.lock = threading.Lock()
        self.connectInput(fs)

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:
        """Take messages from these filters only, with empty queues."""
        self.queues: list[dict[int, Any]] = [{} for _ in fs]
        self.input_connections = [
            each.registerCallback(self.add, queue, index)
            for index, (each, queue) in enumerate(zip(fs, self.queues, strict=True))
        ]

    def add(self, msg: Any, my_queue: dict[int, Any], my_queue_index: int | None = None) -> None:
        """Put a message into its queue; pass on the set that it completes."""
        stamp = Time.from_msg(msg.header.stamp).nanoseconds
        with self.lock:
            self._keep(msg, stamp, my_queue)
            if not all(stamp in queue for queue in self.queues):
                return
            self.signalMessage(*(queue[stamp] for queue in self.queues))
            for queue in self.queues:
                for old in [each for each in queue if each <= stamp]:
                    del queue[old]

    def _keep(self, msg: Any, stamp: int, queue: dict[int, Any]) -> None:
        queue[stamp] = msg
        while len(queue) > self.queue_size:
            del queue[min(queue)]
