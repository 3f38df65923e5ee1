"""Large worlds: bodies that lie still sleep until something moves them, and small worlds never sleep."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from gz_course.sim.gz.sim.physics import integrator, sleeping
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.world import World

WORLD = """<sdf version='1.10'><world name='w'><physics type='x'><max_step_size>0.002</max_step_size></physics>
<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>
<model name='ground'><static>true</static><link name='l'><collision name='c'><geometry><plane/></geometry></collision>
{ground}</link></model>{inside}</world></sdf>"""
BOX = """<model name='b{number}'><pose>{x} 0 {z} 0 0 0</pose><link name='l'>{sensor}<collision name='c'><geometry><box>
<size>1 1 1</size></box></geometry></collision></link></model>"""
IMU = "<sensor name='i' type='imu'/>"
TOUCH = "<sensor name='t' type='contact'><contact><collision>c</collision></contact></sensor>"
BALL = """<model name='ball'><pose>-3 0 0.5 0 0 0</pose><link name='l'><collision name='c'><geometry><sphere>
<radius>0.5</radius></sphere></geometry></collision></link></model>"""


@pytest.fixture(autouse=True)
def large_from_two(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sleeping, "FEWEST", 2)
    monkeypatch.setattr(integrator, "MOST_BODIES", 0)  # as in a world of 300 bodies


def boxes(count: int = 3, inside: str = "", ground: str = "", sensor: str = "") -> World:
    found = (BOX.format(number=n, x=3 * n, z=0.5, sensor=sensor if n == 0 else "") for n in range(count))
    return World.from_string(WORLD.format(inside="".join(found) + inside, ground=ground))


def asleep(data: mujoco.MjData) -> int:
    """Return the number of bodies that sleep."""
    return int(np.count_nonzero(data.tree_asleep >= 0))


def settle(world: World, wanted: int) -> None:
    """Step until that many bodies sleep."""
    for _ in range(100):
        world.step(10)
        if asleep(world.data) == wanted:
            return
    pytest.fail(f"{asleep(world.data)} of {world.model.ntree} bodies sleep, not {wanted}")


def height(world: World, name: str) -> float:
    return float(world.truth.pose(name).position[2])


def test_bodies_that_lie_still_sleep_where_they_lie() -> None:
    world = boxes()
    settle(world, 3)
    world.step(500)
    assert [height(world, f"b{n}") for n in range(3)] == pytest.approx([0.5] * 3, abs=1e-3)
    assert not np.any(world.data.qvel)
    world.reset()
    assert asleep(world.data) == 0


def test_a_new_pose_wakes_a_body() -> None:
    world = boxes()
    settle(world, 3)
    world.editor.set_pose("b1", Pose((3.0, 0.0, 2.0)))
    world.step(1)
    assert asleep(world.data) < 3
    settle(world, 3)
    assert height(world, "b1") == pytest.approx(0.5, abs=1e-3)


def test_a_force_and_a_touch_wake_a_body() -> None:
    world = boxes(inside=BALL)
    settle(world, 4)
    ball = mujoco.mj_name2id(world.model, mujoco.mjtObj.mjOBJ_BODY, "ball::l")
    world.data.xfrc_applied[ball, 0] = 2000.0
    world.step(100)
    world.data.xfrc_applied[ball, 0] = 0.0
    assert asleep(world.data) < 3, "the ball has met the first box"
    assert world.truth.pose("b0").position[0] > 0.01


def test_a_body_falls_when_its_support_is_removed() -> None:
    world = boxes(count=2, inside=BOX.format(number=9, x=0, z=1.5, sensor=""))
    settle(world, 3)
    world.editor.remove("b0")
    world.step(100)
    settle(world, 2)
    assert height(world, "b9") == pytest.approx(0.5, abs=1e-3)


def test_who_is_watched_does_not_sleep() -> None:
    world = boxes(sensor=IMU)
    settle(world, 2)
    world = boxes(ground=TOUCH)
    world.step(200)
    assert asleep(world.data) == 0 and world.data.ncon == 12


def test_a_small_world_is_computed_as_before(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sleeping, "FEWEST", 300)
    world = boxes()
    assert not world.model.opt.enableflags & int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    world.step(200)
    assert asleep(world.data) == 0
