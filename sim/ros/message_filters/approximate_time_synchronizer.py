"""The filter that waits for one message of each input with similar stamps."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

from rclpy.duration import Duration

from gz_course.sim.ros.message_filters.simple_filter import SimpleFilter
from gz_course.sim.ros.message_filters.stamp import arrival_time, refuse_headerless, stamp_of
from gz_course.sim.ros.message_filters.time_synchronizer import TimeSynchronizer


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Sets of messages whose stamps differ by less than `slop` [s], one of each filter in `fs`.

    A message is combined with the nearest ones in the other queues as soon as there is such a set. Messages without a
    stamp are dropped, or with `allow_headerless` get the ROS time of their arrival; with `sync_arrival_time` all do.
    """

    def __init__(
        self,
        fs: Sequence[SimpleFilter],
        queue_size: int,
        slop: float,
        allow_headerless: bool = False,
        sync_arrival_time: bool = False,
    ) -> None:
        self.slop = Duration(seconds=slop)
        self.allow_headerless = allow_headerless
        self.sync_arrival_time = sync_arrival_time
        super().__init__(fs, queue_size)

    def add(self, msg: Any, my_queue: dict[int, Any], my_queue_index: int | None = None) -> None:
        """Put a message into its queue; pass on the set that it completes."""
        time = None if self.sync_arrival_time else stamp_of(msg)
        if time is None:
            if not (self.allow_headerless or self.sync_arrival_time):
                refuse_headerless("message_filters_approx")
                return
            time = arrival_time()
        with self.lock:
            self._keep(msg, time.nanoseconds, my_queue)
            stamps = self._set(time.nanoseconds, my_queue_index)
            if stamps is None:
                return
            self.signalMessage(*(queue[stamp] for queue, stamp in zip(self.queues, stamps, strict=True)))
            for queue, stamp in zip(self.queues, stamps, strict=True):
                del queue[stamp]

    def _set(self, stamp: int, own: int | None) -> tuple[int, ...] | None:
        """Return a stamp [ns] for each queue, those nearest to `stamp` first, that make a set; `own` has `stamp`."""
        slop = self.slop.nanoseconds
        choices: list[list[int]] = []
        for index, queue in enumerate(self.queues):
            if index == own:
                choices.append([stamp] if stamp in queue else [])
            else:
                near = [each for each in queue if abs(each - stamp) <= slop]
                choices.append(sorted(near, key=lambda each: abs(each - stamp)))
        return next((found for found in itertools.product(*choices) if max(found) - min(found) < slop), None)
