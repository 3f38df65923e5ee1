"""Statistics of the messages that a topic brings from other processes: periods, ages and losses.

They need the fifth frame of a message, sent time and number, which processes send that have
GZ_TRANSPORT_TOPIC_STATISTICS=1; those and others do not see one another, because their protocol versions differ. The
times are those of the machine's monotonic clock.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/src/TopicStatistics.cc
Source: https://gazebosim.org/api/transport/13/topicstatistics.html
"""

from __future__ import annotations

import copy
import math
import struct
import threading
import time
from collections.abc import Callable
from typing import Any

STAMP = struct.Struct("<QQ")
"""The fifth frame: time of publication [ms], and the number of the message on its topic, from 0."""
_MOST_SENDERS = 1000


def now_ms() -> int:
    """Return the monotonic time [ms]."""
    return time.monotonic_ns() // 1_000_000


class RunningStatistic:
    """Mean, least, greatest and standard deviation of values that are not kept (Welford's method)."""

    def __init__(self) -> None:
        self.count, self.mean, self._squares = 0, 0.0, 0.0
        self.least, self.greatest = math.inf, -math.inf

    def add(self, value: float) -> None:
        self.count += 1
        off = value - self.mean
        self.mean += off / self.count
        self._squares += off * (value - self.mean)
        self.least, self.greatest = min(self.least, value), max(self.greatest, value)

    @property
    def deviation(self) -> float:
        """Return the standard deviation of the values so far."""
        return math.sqrt(self._squares / self.count) if self.count else 0.0


class TopicStatistics:
    """The statistics of one topic; in the official binding an object without attributes."""

    def __init__(self) -> None:
        self.dropped_message_count = 0
        self.publication, self.reception, self.age = RunningStatistic(), RunningStatistic(), RunningStatistic()
        """Time between two publications, between two arrivals, and from publication to arrival [ms]."""
        self._last: dict[bytes, tuple[int, int, int]] = {}

    def update(self, sender: bytes, stamp: int, number: int, arrived: int) -> None:
        """Count a message of `sender`, sent at `stamp` [ms] as number `number`, that arrived at `arrived` [ms]."""
        last = self._last.get(sender)
        if last is not None:
            last_stamp, last_number, last_arrived = last
            self.publication.add(stamp - last_stamp)
            self.reception.add(arrived - last_arrived)
            self.dropped_message_count += max(0, number - last_number - 1)
        elif len(self._last) >= _MOST_SENDERS:
            return
        self.age.add(arrived - stamp)
        self._last[sender] = stamp, number, arrived

    def message(self) -> Any:
        """Return the statistics as gz.msgs.Metric, with the names of gz-transport."""
        from gz_course.sim.gz.msgs.statistic_pb2 import Metric, Statistic

        metric: Any = Metric(unit="milliseconds")
        kinds: Any = Statistic
        metric.statistics.add(
            type=kinds.SAMPLE_COUNT, name="dropped_message_count", value=float(self.dropped_message_count)
        )
        for group, of in (("publication_statistics", self.publication), ("reception_statistics", self.reception)):
            hertz = 1000.0 / of.mean if of.mean else 0.0
            # "devation" is how gz-transport spells it.
            _fill(metric, group, of, ("avg_hz", hertz), "min_period", "max_period", "period_standard_devation")
        _fill(
            metric,
            "age_statistics",
            self.age,
            ("avg_age", self.age.mean),
            "min_age",
            "max_age",
            "age_standard_devation",
        )
        return metric


def _fill(
    metric: Any, name: str, of: RunningStatistic, average: tuple[str, float], least: str, greatest: str, deviation: str
) -> None:
    from gz_course.sim.gz.msgs.statistic_pb2 import Statistic

    kinds: Any = Statistic
    group = metric.statistics_groups.add(name=name)
    group.statistics.add(type=kinds.AVERAGE, name=average[0], value=average[1])
    group.statistics.add(type=kinds.MINIMUM, name=least, value=of.least if of.count else 0.0)
    group.statistics.add(type=kinds.MAXIMUM, name=greatest, value=of.greatest if of.count else 0.0)
    group.statistics.add(type=kinds.STDDEV, name=deviation, value=of.deviation)


class StatisticsTable:
    """The topics of a process whose statistics are enabled; thread-safe."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._topics: dict[str, tuple[TopicStatistics, Callable[[TopicStatistics], None]]] = {}

    def enable(self, name: str, on_update: Callable[[TopicStatistics], None]) -> None:
        """Begin to count; `on_update` is called after each message, in the thread that received it."""
        with self._lock:
            self._topics[name] = TopicStatistics(), on_update

    def disable(self, name: str) -> None:
        with self._lock:
            self._topics.pop(name, None)

    def get(self, name: str) -> TopicStatistics | None:
        """Return a copy of the statistics of a topic, or None before the first message."""
        with self._lock:
            found = self._topics.get(name)
            return copy.deepcopy(found[0]) if found and found[0].age.count else None

    def record(self, name: str, sender: bytes, stamp: bytes) -> None:
        """Count a message with this fifth frame; one of another length is left out."""
        if name not in self._topics or len(stamp) != STAMP.size:
            return
        with self._lock:
            found = self._topics.get(name)
            if found is None:
                return
            sent, number = STAMP.unpack(stamp)
            found[0].update(sender, sent, number, now_ms())
            statistics, on_update = copy.deepcopy(found[0]), found[1]
        on_update(statistics)
