"""A clock so fast that it costs every Python node a large part of a processor core."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System

FAST = 400.0  # [Hz]; at 1000 Hz an idle rclpy node uses 20 to 35 % of a core


def look(system: System) -> Iterator[Finding]:
    """Find a `/clock` with more than 400 messages per second."""
    clock = system.ros.clock
    if len(clock) < 2 or (span := clock[-1][0] - clock[0][0]) < 0.5:
        return
    rate = (len(clock) - 1) / span
    if rate > FAST:
        yield Finding(
            Severity.NOTE,
            f"/clock comes {rate:.0f} times a second, which keeps every Python node busy.",
            "100 to 250 Hz are enough for a robot: use a larger max_step_size, or bridge a slower clock.",
            (f"{len(clock)} messages in {span:.1f} s",),
        )
