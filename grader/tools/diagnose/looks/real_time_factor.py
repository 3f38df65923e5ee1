"""A simulation slower than the wall clock: every rate measured in wall time is too low."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System

SLOW = 0.8


def look(system: System) -> Iterator[Finding]:
    """Find running worlds with a real-time factor below 0.8 while they were observed."""
    for world in system.gz.worlds:
        running = [each for each in world.statistics if not each.paused]
        if len(running) < 5 or len(world.servers) > 1:
            continue
        first, last = running[0], running[-1]
        real = _seconds(last.real_time) - _seconds(first.real_time)
        factor = (_seconds(last.sim_time) - _seconds(first.sim_time)) / real if real > 0.5 else 1.0
        if factor < SLOW:
            yield Finding(
                Severity.NOTE,
                f"The world {world.name} runs at {factor:.2f} of real time, so ros2 topic hz, which measures in wall "
                "time, shows rates that much too low.",
                "Compare stamps of messages instead, or make the world cheaper (larger max_step_size, fewer or slower "
                "cameras).",
                (f"{_seconds(last.sim_time) - _seconds(first.sim_time):.2f} s simulated in {real:.2f} s",),
            )


def _seconds(time: object) -> float:
    return float(time.sec + time.nsec * 1e-9)  # type: ignore[attr-defined]
