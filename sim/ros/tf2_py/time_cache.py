"""The transforms of one frame to its parent: over time (`TimeCache`), or the one that always holds (`StaticCache`).

All times are nanoseconds; 0 asks for the latest.

Source: tf2/src/cache.cpp and tf2/src/static_cache.cpp of https://github.com/ros2/geometry2
"""

from __future__ import annotations

from bisect import bisect_right
from typing import NamedTuple

from gz_course.sim.ros.tf2_py.rotation import Pose, slerp


class Stored(NamedTuple):
    """The pose of a frame in its parent."""

    parent: str
    pose: Pose


class StaticCache:
    """One transform, which holds at every time."""

    def __init__(self) -> None:
        self._stored: Stored | None = None

    def insert(self, stamp: int, stored: Stored) -> bool:
        self._stored = stored
        return True

    def get(self, time: int) -> Stored | None:
        return self._stored

    def parent(self, time: int) -> str:
        return self._stored.parent if self._stored else ""

    def why_not(self, time: int) -> str:
        return ""

    def clear(self) -> None:
        """Keep the transform: it has no time, so it is never too old."""

    def latest(self) -> tuple[int, str]:
        """Return the time of the latest transform and its parent; a static one has the time 0."""
        return 0, self.parent(0)

    def oldest(self) -> int:
        return 0

    def __len__(self) -> int:
        return 1


class TimeCache:
    """The transforms of the last `cache_time` [ns], in the order of their stamps."""

    def __init__(self, cache_time: int) -> None:
        self._cache_time = cache_time
        self._stamps: list[int] = []
        self._stored: list[Stored] = []
        self._first = 0  # what lies before is too old; it is deleted now and then

    def insert(self, stamp: int, stored: Stored) -> bool:
        """Return whether a transform was taken, which may also be there already; False if it is too old."""
        stamps = self._stamps
        if self._first < len(stamps):
            limit = stamps[-1] - self._cache_time
            while stamps[self._first] < limit:
                self._first += 1
            if self._first > 64 and 2 * self._first > len(stamps):
                del stamps[: self._first], self._stored[: self._first]
                self._first = 0
            if stamp < limit:
                return False
        place = bisect_right(stamps, stamp, self._first)
        before = place - 1
        while before >= self._first and stamps[before] == stamp:
            if self._stored[before] == stored:
                return True
            before -= 1
        stamps.insert(place, stamp)
        self._stored.insert(place, stored)
        return True

    def get(self, time: int) -> Stored | None:
        """Return the transform at a time, between two of them the interpolated one; None outside of their times."""
        stamps, stored = self._stamps, self._stored
        if self._first == len(stamps):
            return None
        if time == 0:
            return stored[-1]
        after = bisect_right(stamps, time, self._first)
        if after == len(stamps):
            return stored[-1] if stamps[-1] == time else None
        if after == self._first:
            return None
        one, two = stored[after - 1], stored[after]
        start = stamps[after - 1]
        if start == time or one.parent != two.parent:
            return one
        return Stored(one.parent, _between(one.pose, two.pose, (time - start) / (stamps[after] - start)))

    def parent(self, time: int) -> str:
        """Return the parent at a time, "" outside of the known times."""
        stored = self.get(time)
        return stored.parent if stored else ""

    def why_not(self, time: int) -> str:
        """Return the sentence that says why `get` has nothing at a time."""
        known = self._stamps[self._first :]
        if not known:
            return ""
        if len(known) == 1:
            return (
                f"Lookup would require extrapolation at time {seconds(time)}, "
                f"but only time {seconds(known[0])} is in the buffer"
            )
        where, which, limit = ("future", "latest", known[-1]) if time > known[-1] else ("past", "earliest", known[0])
        return (
            f"Lookup would require extrapolation into the {where}.  Requested time {seconds(time)} "
            f"but the {which} data is at time {seconds(limit)}"
        )

    def clear(self) -> None:
        """Forget all transforms."""
        self._stamps.clear()
        self._stored.clear()
        self._first = 0

    def latest(self) -> tuple[int, str]:
        """Return the time of the latest transform and its parent; (0, "") if there is none."""
        return (self._stamps[-1], self._stored[-1].parent) if self._stamps else (0, "")

    def oldest(self) -> int:
        return self._stamps[self._first] if self._stamps else 0

    def __len__(self) -> int:
        return len(self._stamps) - self._first


Cache = StaticCache | TimeCache


def seconds(time: int) -> str:
    """Return a time [ns] as text in seconds, as in all sentences of tf2."""
    return f"{time * 1e-9:.6f}"


def _between(one: Pose, two: Pose, ratio: float) -> Pose:
    x, y, z, w = slerp(one[3:], two[3:], ratio)
    return (
        one[0] + (two[0] - one[0]) * ratio,
        one[1] + (two[1] - one[1]) * ratio,
        one[2] + (two[2] - one[2]) * ratio,
        x,
        y,
        z,
        w,
    )
