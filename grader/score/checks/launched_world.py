"""`launched_world`: does the simulator run the world that an argument of the launch names?

kind = "launched_world"
argument = "world"
default = "lidar_room.sdf"    # when the argument is not given
"""

from __future__ import annotations

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.launched import argument, declared, ran


@check_kind("launched_world")
def launched_world(recording: Recording, parameters: Table) -> Finding:
    """Pass if the first simulator that ran has the world of this run's argument."""
    name, default = parameters.text("argument"), parameters.text("default")
    wanted, called = argument(recording, name, default)
    running = ran(recording)
    expected = f"{called}: the world {wanted}"
    if not running:
        return Finding(False, expected, "no simulator ran")
    found = running[0]["world"]
    why = "" if found == wanted else declared(recording, name, default) or _fixed(recording, found)
    return Finding(found == wanted, expected, f"{called} it ran {found}", explanation=why)


def _fixed(recording: Recording, world: str) -> str:
    """Return where the launch file names this world, whatever it is called with; empty if nowhere."""
    for place in recording.facts().get("fixed_worlds", []):
        if place["world"] == world:
            where = f"{place['file']}, line {place['line']}"
            return f"{where}: {world} is written into the command, whatever the argument says"
    return ""
