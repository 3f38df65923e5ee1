"""Does the simulator load a world and step it?"""

from __future__ import annotations

from gz_course.grader.tools.doctor.probe import ProbeError, Probes
from gz_course.grader.tools.doctor.verdict import Verdict, failed, fine

TITLE = "physics"
WORLD, STEPS = "lidar_room.sdf", 50
_CODE = """
import sys
import mujoco
import numpy
from gz_course.sim.gz.sim.world import World
world = World.load(sys.argv[1])
before = world.sim_time_ns
for _ in range(int(sys.argv[2])):
    world.step()
if world.sim_time_ns <= before or not numpy.isfinite(world.data.qpos).all():
    sys.exit(f"{sys.argv[2]} steps led to {world.sim_time_ns} ns and {world.data.qpos}")
print(f"MuJoCo {mujoco.__version__} stepped {sys.argv[1]} to {world.sim_time_ns / 1e9:g} s")
world.close()
"""


def examine(probes: Probes) -> Verdict:
    """Simulate a moment of the exercises' room."""
    try:
        return fine(probes.run(_CODE, WORLD, str(STEPS)).splitlines()[-1])
    except ProbeError as error:
        return failed(
            f"{WORLD} cannot be simulated: {error}",
            "install the tested version again: `pip install -c constraints.txt --force-reinstall mujoco`",
        )
