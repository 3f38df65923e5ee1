"""Sensors in a world without the system that runs them: they exist and stay silent."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System, names


def look(system: System) -> Iterator[Finding]:
    """Find the systems that sensors of a world need and the world does not load, one finding each."""
    for world in system.gz.worlds:
        if world.text is None or not world.text.sensors:
            continue
        from gz_course.sim.gz.sim.plugins.sensor import sensor_types
        from gz_course.sim.gz.sim.plugins.system import systems

        types = sensor_types()
        needed: dict[str, list[str]] = {}
        kinds: dict[str, set[str]] = {}
        for sensor in world.text.sensors:
            if sensor.type in types and types[sensor.type].runs_in not in world.text.systems:
                needed.setdefault(types[sensor.type].runs_in, []).append(sensor.name)
                kinds.setdefault(types[sensor.type].runs_in, set()).add(sensor.type)
        for missing, sensors in sorted(needed.items()):
            yield Finding(
                Severity.ERROR,
                f"The world {world.name} has the sensor {names(sensors[:3])} ({names(kinds[missing])}) but not the "
                f"system {missing}, which runs it: it stays silent.",
                f"Add to the <world>: <plugin filename='{systems()[missing].filename}' "
                f"name='gz::sim::systems::{missing}'/>",
                (f"systems of the world: {names(world.text.systems)}",),
            )
