"""`BufferCore`: takes transforms between frames and answers what the transform between any two frames is.

Frames are a forest: every frame but the roots has one parent, and its transforms to that parent in a cache of
`time_cache`. A lookup walks from the source frame up to the root, then from the target frame up to where it meets the
first way. The sentences of exceptions and warnings are those of tf2.

Source: tf2/src/buffer_core.cpp and tf2_py/src/tf2_py.cpp of https://github.com/ros2/geometry2
"""

from __future__ import annotations

import sys
import threading
from typing import Any

from geometry_msgs.msg import TransformStamped
from rclpy.time import Time

from gz_course.sim.ros.tf2_py import frame_texts
from gz_course.sim.ros.tf2_py.exceptions import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TransformException,
)
from gz_course.sim.ros.tf2_py.rotation import IDENTITY, Pose, canonical, combine, inverse
from gz_course.sim.ros.tf2_py.time_cache import Cache, StaticCache, Stored, TimeCache, seconds

_CACHE_TIME = 10 * 10**9  # [ns]
_DEEPEST = 1000  # frames between a frame and its root; more are taken for a loop


class BufferCore:
    """The frames and their transforms of the last `cache_time`, a Duration, by default 10 s.

    A time is a message or an rclpy Time; 0 asks for the latest time at which all transforms on the way are known.
    Methods may be called from several threads.
    """

    def __init__(self, cache_time: Any = None) -> None:
        self._cache_time = _CACHE_TIME if cache_time is None else _nanoseconds(cache_time, "duration")
        self._frames: dict[str, Cache | None] = {}  # None: a root
        self._authorities: dict[str, str] = {}
        self._lock = threading.RLock()

    def set_transform(self, transform: TransformStamped, authority: str) -> None:
        """Take a transform that holds at its stamp; what makes no sense is ignored with a line on stderr."""
        self._set(transform, authority, is_static=False)

    def set_transform_static(self, transform: TransformStamped, authority: str) -> None:
        """Take a transform that holds at every time; what makes no sense is ignored with a line on stderr."""
        self._set(transform, authority, is_static=True)

    def lookup_transform_core(self, target_frame: str, source_frame: str, time: Any) -> TransformStamped:
        """Return the transform that takes coordinates in `source_frame` to `target_frame`."""
        with self._lock:
            stamp, pose = self._lookup(target_frame, source_frame, _nanoseconds(time))
        return _message(target_frame, source_frame, stamp, pose)

    def lookup_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> TransformStamped:
        """Return the transform from `source_frame` at one time to `target_frame` at another.

        Between the two times, `fixed_frame` is where nothing moves.
        """
        target_ns, source_ns = _nanoseconds(target_time), _nanoseconds(source_time)
        with self._lock:
            self._need(target_frame, "lookupTransform argument target_frame")
            self._need(source_frame, "lookupTransform argument source_frame")
            self._need(fixed_frame, "lookupTransform argument fixed_frame")
            _, inner = self._lookup(fixed_frame, source_frame, source_ns)
            stamp, outer = self._lookup(target_frame, fixed_frame, target_ns)
        return _message(target_frame, source_frame, stamp, combine(outer, inner))

    def can_transform_core(self, target_frame: str, source_frame: str, time: Any) -> tuple[bool, str]:
        """Return whether a lookup would succeed, and if not, why."""
        time_ns = _nanoseconds(time)
        if target_frame == source_frame:
            return True, ""
        with self._lock:
            why_not = self._invalid(target_frame, "target_frame") or self._invalid(source_frame, "source_frame")
            why_not = why_not or self._why_not(target_frame, source_frame, time_ns)
        return not why_not, why_not

    def can_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> tuple[bool, str]:
        """Return whether `lookup_transform_full_core` would succeed, and if not, why."""
        target_ns, source_ns = _nanoseconds(target_time), _nanoseconds(source_time)
        with self._lock:
            why_not = (
                self._invalid(target_frame, "target_frame")
                or self._invalid(source_frame, "source_frame")
                or self._invalid(fixed_frame, "fixed_frame")
                or self._why_not(target_frame, fixed_frame, target_ns)
                or self._why_not(fixed_frame, source_frame, source_ns)
            )
        return not why_not, why_not

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """Return the latest time at which all transforms between two frames are known."""
        with self._lock:
            self._need(target_frame, "get_latest_common_time")
            self._need(source_frame, "get_latest_common_time")
            try:
                return Time(nanoseconds=self._latest_common_time(target_frame, source_frame))
            except TransformException as error:
                raise TransformException(str(error)) from None

    def all_frames_as_yaml(self) -> str:
        """Return parent, broadcaster, rate and times of each frame, in YAML."""
        with self._lock:
            return frame_texts.as_yaml(self._frames, self._authorities)

    def all_frames_as_string(self) -> str:
        """Return a line for each frame that has a parent."""
        with self._lock:
            return frame_texts.as_string(self._frames)

    def clear(self) -> None:
        """Forget all transforms but static ones; the names of the frames stay."""
        with self._lock:
            for cache in self._frames.values():
                if cache is not None:
                    cache.clear()

    def _allFramesAsDot(self, time: Any = None) -> str:
        with self._lock:
            return frame_texts.as_dot(self._frames, self._authorities, _nanoseconds(time) if time is not None else 0)

    def _frameExists(self, frame_id: str) -> bool:
        return frame_id in self._frames

    def _getFrameStrings(self) -> list[str]:
        with self._lock:
            return list(self._frames)

    def _chain(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> list[str]:
        """Return the names of the frames on the way from `source_frame` by `fixed_frame` to `target_frame`."""
        target_ns, source_ns = _nanoseconds(target_time), _nanoseconds(source_time)
        with self._lock:
            there, back = [source_frame], [target_frame]
            self._walk(fixed_frame, source_frame, source_ns, there)
            self._walk(fixed_frame, target_frame, target_ns, back)
        while len(there) > 1 and len(back) > 1 and there[-2] == back[-2]:  # a detour by the fixed frame
            there.pop()
            back.pop()
        return there + back[-2::-1]

    def _set(self, transform: TransformStamped, authority: str, is_static: bool) -> None:
        parent = transform.header.frame_id.removeprefix("/")
        child = transform.child_frame_id.removeprefix("/")
        place, turn = transform.transform.translation, transform.transform.rotation
        pose = (place.x, place.y, place.z, *canonical(turn.x, turn.y, turn.z, turn.w))
        errors = frame_texts.errors(parent, child, pose, authority)
        if errors:
            print(*(f"Error:   {error}" for error in errors), sep="\n", file=sys.stderr)
            return
        stamp = _nanoseconds(transform.header.stamp)
        with self._lock:
            cache = self._frames.get(child)
            if cache is None or isinstance(cache, StaticCache) is not is_static:
                cache = self._frames[child] = StaticCache() if is_static else TimeCache(self._cache_time)
            self._frames.setdefault(parent, None)
            if cache.insert(stamp, Stored(parent, pose)):
                self._authorities[child] = authority
                return
        print(
            f"Warning: TF_OLD_DATA ignoring data from the past for frame {child} at time {seconds(stamp)} "
            f"according to authority {authority}\n"
            "Possible reasons are listed at http://wiki.ros.org/tf/Errors%20explained",
            file=sys.stderr,
        )

    def _need(self, frame: str, what: str) -> None:
        """Raise an exception if there is no frame of this name; `what` is what the name was given for."""
        if frame in self._frames:
            return
        if not frame:
            raise InvalidArgumentException(f'Invalid argument "" passed to {what} - in tf2 frame_ids cannot be empty')
        if frame.startswith("/"):
            raise InvalidArgumentException(
                f"Invalid argument \"{frame}\" passed to {what} - in tf2 frame_ids cannot start with a '/'"
            )
        raise LookupException(f'"{frame}" passed to {what} does not exist. ')

    def _invalid(self, frame: str, argument: str) -> str:
        """Return why no frame of this name can be transformed, or ""."""
        if frame in self._frames:
            return ""
        reason = "frame does not exist"
        if not frame:
            reason = "in tf2 frame_ids cannot be empty"
        elif frame.startswith("/"):
            reason = "in tf2 frame_ids cannot start with a '/'"
        return f'Invalid frame ID "{frame}" passed to canTransform argument {argument} - {reason}'

    def _why_not(self, target: str, source: str, time: int) -> str:
        try:
            self._walk(target, source, time)
        except TransformException as error:
            return str(error)
        return ""

    def _lookup(self, target: str, source: str, time: int) -> tuple[int, Pose]:
        """Return the time [ns] for which the answer holds, and the pose of `source` in `target`."""
        if target == source:
            cache = self._frames.get(target)
            return (cache.latest()[0] if cache and not time else time), IDENTITY
        self._need(target, "lookupTransform argument target_frame")
        self._need(source, "lookupTransform argument source_frame")
        return self._walk(target, source, time)

    def _walk(self, target: str, source: str, time: int, way: list[str] | None = None) -> tuple[int, Pose]:
        """Do as `_lookup` for two frames that exist; the frames after `source` are appended to `way`."""
        if target == source:
            return time, IDENTITY
        if time == 0:
            time = self._latest_common_time(target, source)
        frames = self._frames
        passed = [source]
        poses = [IDENTITY]
        stuck = ""  # why the way up ended before a root
        frame = source
        while frame != target and (cache := frames.get(frame)) is not None:
            stored = cache.get(time)
            if stored is None:
                stuck = f"{cache.why_not(time)}, {_when(target, source)}"
                break
            frame = stored.parent
            passed.append(frame)
            poses.append(combine(stored.pose, poses[-1]))
            self._check_depth(len(passed))
        met = len(passed) - 1
        back = [target]
        below = IDENTITY
        frame = target
        while frame != passed[met]:
            if frame in passed:
                met = passed.index(frame)
                break
            cache = frames.get(frame)
            if cache is None:
                if stuck:
                    raise ExtrapolationException(stuck)
                raise _not_connected(target, source)
            stored = cache.get(time)
            if stored is None:
                raise ExtrapolationException(f"{cache.why_not(time)}, {_when(target, source)}")
            frame = stored.parent
            back.append(frame)
            below = combine(stored.pose, below)
            self._check_depth(len(back))
        if way is not None:
            way += passed[1 : met + 1] + back[-2::-1]
        return time, poses[met] if len(back) == 1 else combine(inverse(below), poses[met])

    def _latest_common_time(self, target: str, source: str) -> int:
        """Return the latest time [ns] at which all transforms between two frames are known; 0 if all are static."""
        if target == source:
            cache = self._frames.get(source)
            return cache.latest()[0] if cache else 0
        up = self._latest_upwards(source, target)
        if up and up[-1][1] == target:
            return _earliest(up)
        parents = {parent: place for place, (_, parent) in reversed([*enumerate(up)])}
        down = self._latest_upwards(target, source, parents)
        if down and down[-1][1] == source:
            return _earliest(down)
        if not down or down[-1][1] not in parents:
            raise _not_connected(target, source)
        return _earliest(down + up[: parents[down[-1][1]] + 1])

    def _latest_upwards(self, frame: str, end: str, ends: dict[str, int] | None = None) -> list[tuple[int, str]]:
        """Return latest time and parent of a frame and those above it, up to `end`, one of `ends`, or a root."""
        found: list[tuple[int, str]] = []
        while (cache := self._frames.get(frame)) is not None:
            latest = cache.latest()
            frame = latest[1]
            if not frame:
                break
            found.append(latest)
            if frame == end or (ends and frame in ends):
                break
            self._check_depth(len(found))
        return found

    def _check_depth(self, depth: int) -> None:
        if depth > _DEEPEST:
            raise LookupException(
                f"The tf tree is invalid because it contains a loop.\n{frame_texts.as_string(self._frames)}\n"
            )


def _nanoseconds(time: Any, what: str = "time") -> int:
    if hasattr(time, "sec") and hasattr(time, "nanosec"):
        return int(time.sec * 10**9 + time.nanosec)
    if hasattr(time, "nanoseconds"):
        return int(time.nanoseconds)
    raise TypeError(f"{what} must have sec and nanosec, or nanoseconds.")


def _earliest(found: list[tuple[int, str]]) -> int:
    return min((stamp for stamp, _ in found if stamp), default=0)


def _when(target: str, source: str) -> str:
    return f"when looking up transform from frame [{source}] to frame [{target}]"


def _not_connected(target: str, source: str) -> ConnectivityException:
    return ConnectivityException(
        f"Could not find a connection between '{target}' and '{source}' because they are not part of the same tree."
        "Tf has two or more unconnected trees."
    )


def _message(target: str, source: str, stamp: int, pose: Pose) -> TransformStamped:
    message = TransformStamped(child_frame_id=source)
    header, place, turn = message.header, message.transform.translation, message.transform.rotation
    header.frame_id = target
    header.stamp.sec, header.stamp.nanosec = divmod(stamp, 10**9)
    place.x, place.y, place.z = pose[:3]
    turn.x, turn.y, turn.z, turn.w = canonical(*pose[3:])
    return message
