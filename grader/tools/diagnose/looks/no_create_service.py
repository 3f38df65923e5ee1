"""A world into which nothing can be spawned: the system UserCommands, which offers the service, is not loaded."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System

BEFORE = ("keeps_driving",)


def look(system: System) -> Iterator[Finding]:
    """Find worlds without `/world/W/create`."""
    offered = {service.topic for service in system.gz.services}
    for world in system.gz.worlds:
        if f"/world/{world.name}/create" in offered:
            continue
        others = sorted(world.text.systems) if world.text is not None else []
        yield Finding(
            Severity.WARNING,
            f"The world {world.name} has no service /world/{world.name}/create: nothing can be spawned into it.",
            "Add to the <world>: <plugin filename='gz-sim-user-commands-system' "
            "name='gz::sim::systems::UserCommands'/>; a world that names one plugin loses the default ones.",
            (f"systems of the world: {', '.join(others)}",) if others else (),
        )
