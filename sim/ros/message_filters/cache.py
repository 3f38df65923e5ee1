"""The filter that remembers the last messages and finds them by time."""

from __future__ import annotations

from typing import Any

from rclpy.time import Time

from gz_course.sim.ros.message_filters.simple_filter import SimpleFilter
from gz_course.sim.ros.message_filters.stamp import arrival_time, refuse_headerless, stamp_of


class Cache(SimpleFilter):
    """The last `cache_size` messages of the filter `f`, in the order of their arrival.

    Messages without a stamp are dropped, or with `allow_headerless` get the ROS time of their arrival.
    """

    def __init__(self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False) -> None:
        super().__init__()
        self.cache_size = cache_size
        self.cache_msgs: list[Any] = []
        self.cache_times: list[Time] = []
        self.allow_headerless = allow_headerless
        self.connectInput(f)

    def connectInput(self, f: SimpleFilter) -> None:
        """Take the messages of another filter, too."""
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """Remember a message, forget the oldest if there are too many, and pass it on."""
        stamp = stamp_of(msg)
        if stamp is None:
            if not self.allow_headerless:
                refuse_headerless("message_filters_cache")
                return
            stamp = arrival_time()
        self.cache_times.append(stamp)
        self.cache_msgs.append(msg)
        if len(self.cache_msgs) > self.cache_size:
            del self.cache_msgs[0]
            del self.cache_times[0]
        self.signalMessage(msg)

    def getInterval(self, from_stamp: Time, to_stamp: Time) -> list[Any]:
        """Return the messages from one time to another, both included. Raises AssertionError if they are swapped."""
        assert from_stamp <= to_stamp
        pairs = zip(self.cache_msgs, self.cache_times, strict=True)
        return [message for message, time in pairs if from_stamp <= time <= to_stamp]

    def getElemAfterTime(self, stamp: Time) -> Any:
        """Return the first message that arrived of those at or after a time, or None."""
        pairs = zip(self.cache_msgs, self.cache_times, strict=True)
        return next((message for message, time in pairs if time >= stamp), None)

    def getElemBeforeTime(self, stamp: Time) -> Any:
        """Return the last message that arrived of those at or before a time, or None."""
        pairs = zip(reversed(self.cache_msgs), reversed(self.cache_times), strict=True)
        return next((message for message, time in pairs if time <= stamp), None)

    def getLastestTime(self) -> Time | None:
        """Return the stamp of the last message, or None. The name is spelt as in ROS 2."""
        return self.cache_times[-1] if self.cache_times else None

    def getOldestTime(self) -> Time | None:
        """Return the stamp of the first message, or None."""
        return self.cache_times[0] if self.cache_times else None

    def getLast(self) -> Any:
        """Return the first message that is not older than the last one, or None."""
        last = self.getLastestTime()
        return None if last is None else self.getElemAfterTime(last)
