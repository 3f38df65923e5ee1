"""Transforms: a lookup over a chain of five frames, the broadcast of a transform, a buffer that is full."""

import time
from collections.abc import Callable, Iterator

from geometry_msgs.msg import TransformStamped
from rclpy.time import Time

from gz_course.sim.ros.tf2_py import BufferCore
from gz_course.tests.bench.row import Row

LINKS, STAMPS, RATE_HZ = 5, 500, 50
ROUNDS, CALLS = 5, 1000
LOOKUP_US = 150


def rows() -> Iterator[Row]:
    buffer = BufferCore()
    for tick in range(STAMPS):
        for transform in _chain(tick):
            buffer.set_transform(transform, "bench")
    between = Time(nanoseconds=round((STAMPS - 1.5) / RATE_HZ * 1e9) + 10**9)
    message = _took(lambda: TransformStamped(child_frame_id="a"))
    ends = ("frame0", f"frame{LINKS}")
    for name, call in (
        ("between two stamps", lambda: buffer.lookup_transform_core(*ends, between)),
        ("the other way", lambda: buffer.lookup_transform_core(*reversed(ends), between)),
        ("at the latest common time", lambda: buffer.lookup_transform_core(*ends, Time())),
        ("that is too late", lambda: buffer.can_transform_core(*ends, Time(seconds=1000))),
    ):
        took = _took(call)
        yield Row(
            f"tf2, lookup over a chain of {LINKS}, {name}",
            f"{took:.0f} µs",
            f"an empty TransformStamped {message:.1f} µs",
            f"{took / message:.1f}",
            f"at most {LOOKUP_US} µs",
        )
    newest = iter(range(STAMPS, STAMPS + 2 * ROUNDS * CALLS))
    took = _took(lambda: [buffer.set_transform(each, "bench") for each in _chain(next(newest))])
    made = _took(lambda: _chain(0))
    yield Row(
        f"tf2, {LINKS} transforms into a full buffer", f"{took - made:.0f} µs", f"making them {made:.0f} µs",
        f"{(took - made) / made:.1f}", "-",
    )  # fmt: skip


def _chain(tick: int) -> list[TransformStamped]:
    made = []
    for link in range(LINKS):
        transform = TransformStamped(child_frame_id=f"frame{link + 1}")
        transform.header.frame_id = f"frame{link}"
        transform.header.stamp.sec, nanoseconds = divmod(tick, RATE_HZ)
        transform.header.stamp.sec += 1
        transform.header.stamp.nanosec = nanoseconds * (10**9 // RATE_HZ)
        transform.transform.translation.x = float(tick)
        transform.transform.rotation.z = 0.1 * link
        made.append(transform)
    return made


def _took(call: Callable[[], object]) -> float:
    """Return the processor time of a call [µs]: the best of some rounds."""
    means = []
    for _ in range(ROUNDS):
        started = time.process_time()
        for _ in range(CALLS):
            call()
        means.append((time.process_time() - started) / CALLS * 1e6)
    return min(means)
