"""Bodies that start inside each other are named and come apart slowly; others are as they were."""

from __future__ import annotations

import numpy as np
import pytest

from gz_course.sim.gz.sim.physics.overlaps import FASTEST
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.world import World

WORLD = """<sdf version='1.10'><world name='w'><physics type='x'><max_step_size>{step}</max_step_size></physics>
<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>
<include><uri>model://ground_plane</uri></include>{inside}</world></sdf>"""
BOX = """<model name='{name}'><pose>{x} 0 {z} 0 0 0</pose><link name='l'><inertial><mass>1</mass><inertia>
<ixx>0.16</ixx><iyy>0.16</iyy><izz>0.16</izz></inertia></inertial><collision name='c'><geometry><box>
<size>1 1 1</size></box></geometry></collision></link></model>"""


def world_of(*places: tuple[float, float], step: float = 0.001) -> World:
    boxes = "".join(BOX.format(name=f"b{number}", x=x, z=z) for number, (x, z) in enumerate(places))
    return World.from_string(WORLD.format(step=step, inside=boxes))


def fastest(world: World, steps: int) -> float:
    """Step and return the largest speed [m/s] of a box."""
    top = 0.0
    for _ in range(steps):
        world.step()
        speeds = (np.linalg.norm(world.truth.velocity(name).linear) for name in world.model_names())
        top = max(top, *map(float, speeds))
    return top


@pytest.mark.parametrize(("places", "depth"), [(((0, 0.5), (0.5, 0.5)), 0.5), (((0, 0.45),), 0.05)])
def test_an_overlap_is_named_and_ends_slowly(places: tuple[tuple[float, float], ...], depth: float) -> None:
    world = world_of(*places, step=0.004)
    (warning,) = world.warnings
    assert "'b0::l::c'" in warning and f"are {depth:g} m inside each other" in warning
    start = world.data.qpos.copy()
    for _ in range(2):
        assert fastest(world, 750) < 1.05 * FASTEST
        assert max(-world.data.contact.dist) < 0.005, "they have come apart"
        assert max(world.truth.pose(name).position[2] for name in world.model_names()) == pytest.approx(0.5, abs=0.005)
        world.reset()
        assert (world.data.qpos == start).all()


def test_bodies_that_touch_are_not_changed() -> None:
    touching, apart = world_of((0, 0.5), (1.0, 0.499)), world_of((0, 0.5), (3.0, 0.5))
    assert (touching.warnings, touching.model.npair) == ([], apart.model.npair)


def test_a_body_that_is_set_down_inside_another_is_pushed_out_too() -> None:
    world = world_of((0, 0.5), (3.0, 0.5))
    world.step(10)
    same = world.model
    world.editor.set_pose("b1", Pose((2.0, 0.0, 0.5)))
    assert world.model is same, "nothing overlaps"
    world.editor.set_pose("b1", Pose((0.6, 0.0, 0.5)))
    assert world.model is not same
    same = world.model
    assert fastest(world, 2500) < FASTEST
    assert max(-world.data.contact.dist) < 0.005, "they have come apart"
    world.editor.set_pose("b1", Pose((4.0, 0.0, 0.5)))
    world.editor.set_pose("b1", world.truth.pose("b0") * Pose((0.6, 0.0, 0.0)))
    assert world.model is same, "the pair is known"
    assert fastest(world, 500) < FASTEST


def test_a_body_that_is_created_inside_another_is_pushed_out_too() -> None:
    world = world_of((0, 0.5))
    world.step(10)
    box = BOX.format(name="late", x=0.7, z=0.5)
    world.editor.spawn(f"<sdf version='1.10'>{box}</sdf>")
    assert any("'late::l::c'" in warning and "0.3 m inside" in warning for warning in world.warnings)
    assert fastest(world, 500) < FASTEST
