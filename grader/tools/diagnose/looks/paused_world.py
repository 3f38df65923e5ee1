"""A paused world: topics exist, the clock stands still, sensors and drives are silent."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System


def look(system: System) -> Iterator[Finding]:
    """Find worlds whose last statistics say `paused`."""
    for world in system.gz.worlds:
        if not world.statistics or not world.statistics[-1].paused:
            continue
        now = world.statistics[-1].sim_time
        yield Finding(
            Severity.ERROR,
            f"The world {world.name} is paused at {now.sec + now.nsec * 1e-9:.3f} s: no sensor measures and nothing "
            "moves.",
            f"Start it with gz sim -r, or let it run: gz service -s /world/{world.name}/control --reqtype "
            "gz.msgs.WorldControl --reptype gz.msgs.Boolean --req 'pause: false'",
            (f"statistics: {world.statistics[-1].iterations} steps, real time factor 0",),
        )
