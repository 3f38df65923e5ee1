"""A bridge, or nodes that need one, without a simulator in this Gazebo partition."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System, names


def look(system: System) -> Iterator[Finding]:
    """Find bridges in a partition without a world."""
    entries = system.entries()
    if system.gz.worlds or not entries:
        return
    if any(system.gz_users(entry.gz_topic, publish=way) for _, entry in entries for way in (True, False)):
        return  # the other end is not a simulator
    elsewhere = [
        f"partition {partition or '(empty)'} has the world {names(worlds)}"
        for partition, worlds in sorted(system.gz.elsewhere.items())
    ]
    yield Finding(
        Severity.ERROR,
        f"The bridge {names(bridge.node for bridge, _ in entries)} runs, but no simulator runs in the Gazebo "
        f"partition {system.gz.partition!r}.",
        "Start it (gz sim WORLD -r)"
        + (
            ", or set GZ_PARTITION to its partition for every terminal."
            if elsewhere
            else "; is it in this terminal's GZ_PARTITION and GZ_IP?"
        ),
        tuple(elsewhere[:5]),
        frozenset(entry.ros_topic for _, entry in entries),
    )
