"""Several simulators in one Gazebo partition: their commands and clocks mix."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System, names

BEFORE = ("clock_loop", "no_clock", "two_clocks")


def look(system: System) -> Iterator[Finding]:
    """Find more than one world, or one world with several servers."""
    worlds = system.gz.worlds
    servers = sum(len(world.servers) for world in worlds)
    if servers < 2:
        return
    shown = names(world.name for world in worlds)
    what = f"worlds {shown}" if len(worlds) > 1 else f"simulators of the world {shown}"
    number = len(worlds) if len(worlds) > 1 else servers
    yield Finding(
        Severity.ERROR,
        f"{number} {what} run in the Gazebo partition {system.gz.partition!r}: subscribers receive all of them.",
        "End the one that is left over from an earlier run (pgrep -af 'gz sim'), or give each run its own "
        "GZ_PARTITION.",
        tuple(f"{world.name}: {len(world.servers)} server{'s' if len(world.servers) > 1 else ''}" for world in worlds),
    )
