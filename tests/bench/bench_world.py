"""How quickly a world is stepped, against MuJoCo alone stepping the same model, and what a spawn costs."""

import time
from collections.abc import Callable, Iterator

import mujoco

from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_MODELS
from gz_course.sim.gz.sim.world import World
from gz_course.tests.bench.row import Row

STEPS, RUNS = 2000, 7


def per_second(run: Callable[[int], object]) -> float:
    """Return the best steps per second of some runs."""
    best = 0.0
    for _ in range(RUNS):
        start = time.perf_counter()
        run(STEPS)
        best = max(best, STEPS / (time.perf_counter() - start))
    return best


def rows() -> Iterator[Row]:
    world = World.load("lidar_room.sdf")
    drive = next(each for each in world.systems if each.name == "DiffDrive")
    drive.command(0.2, 0.3)
    world.step(1000)
    own = per_second(world.step)
    bare = per_second(lambda n: mujoco.mj_step(world.model, world.data, nstep=n))
    yield Row(
        "lidar_room.sdf uncapped, nobody listens",
        f"{own * 1e-3:.0f} x real time",
        f"mj_step in C: {bare * 1e-3:.0f} x",
        f"{own / bare:.2f}",
        "at least 0.3",
    )
    text = (BUILT_IN_MODELS / "two_wheel_robot" / "model.sdf").read_text()
    spawns, removes = [], []
    for number in range(RUNS):
        start = time.perf_counter()
        name = world.editor.spawn(text, name="second", pose=Pose((1.0 + number * 0.1, -2.0, 0.0)))
        spawns.append(time.perf_counter() - start)
        start = time.perf_counter()
        world.editor.remove(name)
        removes.append(time.perf_counter() - start)
    start = time.perf_counter()
    World.load("lidar_room.sdf")
    load = time.perf_counter() - start
    yield Row(
        "spawning a robot into a running world",
        f"{min(spawns) * 1e3:.1f} ms, removing it {min(removes) * 1e3:.1f} ms",
        f"loading the world: {load * 1e3:.1f} ms",
        f"{min(spawns) / load:.2f}",
        "at most 1",
    )
