"""Numbers at the edge of what physics can take: the world stays finite, and a sentence says what cannot be held."""

import math

import pytest

from gz_course.sim.gz.sim.systems.diff_drive import DiffDrive
from gz_course.sim.gz.sim.world import World
from gz_course.tests.conformance.physics.bricks import (
    apply_force,
    arm,
    box,
    built_in,
    four_wheel_robot,
    friction,
    ground,
    joint_controller,
    three_point_robot,
)
from gz_course.tests.conformance.physics.scene import Scene

SERVO, FORCE = joint_controller("joint"), apply_force("joint")
CASES = {
    "a limit of 1e-9": arm("", "<lower>-1e-9</lower><upper>1e-9</upper>"),
    "a servo in a limit of 1e-9": arm("", "<lower>-1e-9</lower><upper>1e-9</upper>", SERVO),
    "an effort of 1e15": arm("", "<effort>1e15</effort>", SERVO),
    "an effort of 1e16": arm("", "<effort>1e16</effort>", SERVO),
    "an effort of 1e-9": arm("", "<effort>1e-9</effort>", SERVO),
    "a velocity of 1e-9": arm("", "<velocity>1e-9</velocity>", SERVO),
    "a friction of 1e14": arm("<friction>1e14</friction>", plugin=SERVO),
    "a damping of 1e14": arm("<damping>1e14</damping>"),
    "a force of 1e15": arm(plugin=FORCE),
    "a caster of mu 1e5": ground(1e5) + three_point_robot(1e5),
    "a mass ratio of 1e6": ground() + box("a", "0 0 0.1 0 0 0", 1e-3) + box("b", "0 0 0.3 0 0 0", 1e3),
}


def load(models: str) -> World:
    return World.from_string(Scene("extreme", models, 1.0, ()).sdf)


@pytest.mark.parametrize("name", CASES)
def test_the_world_stays_finite(name):
    world = load(CASES[name])
    for system in world.systems:
        if isinstance(system, DiffDrive):
            system.command(0.5, 0.5)
        elif type(system).__name__ in ("JointController", "ApplyJointForce"):
            system.command(1e15 if "force" in name else 1.0)
    world.step(1000)
    assert all(map(math.isfinite, world.data.qpos.tolist() + world.data.qvel.tolist()))


def test_masses_that_differ_too_much_are_told():
    (warning,) = load(CASES["a mass ratio of 1e6"]).warnings
    assert "model 'b' of 1e+03 kg is 1e+06 times as heavy as model 'a' of 0.001 kg" in warning
    assert load(ground() + box("a", "0 0 0.1 0 0 0", 0.1) + box("b", "0 0 0.3 0 0 0", 1e3)).warnings == []


@pytest.mark.parametrize(
    ("surface", "told"),
    [
        (friction(1.0), True),
        (friction(1.0, "<slip1>0.035</slip1><fdir1>0 0 1</fdir1>"), False),
        (friction(0.1, "<mu2>1</mu2><fdir1>0 0 1</fdir1>"), False),
    ],
)
def test_four_wheels_that_grip_sideways_are_told(surface, told):
    warnings = load(ground() + four_wheel_robot(surface)).diagnostics.differences
    assert any("grip sideways, so it turns here, but hardly in Gazebo" in each for each in warnings) == told


@pytest.mark.parametrize("more", ["<slip1>0.035</slip1><fdir1>0 0 1</fdir1>", "<mu2>0.1</mu2><fdir1>0 0 -2</fdir1>"])
def test_directions_that_are_simulated_are_not_told(more):
    warnings = load(ground() + four_wheel_robot(friction(1.0, more))).warnings
    assert [each for each in warnings if "fdir1" in each or "slip" in each or "mu2" in each] == []
    turned = load(ground() + four_wheel_robot(friction(1.0, more.replace("0 0", "0 1")))).warnings
    assert any("is ignored" in each for each in turned)


@pytest.mark.parametrize(
    ("robot", "told"),
    [
        (three_point_robot(0.0, tyre="cylinder"), 1),
        (three_point_robot(0.0, tyre="cylinder").replace("<length>0.03</length>", "<length>0.001</length>"), 0),
        (three_point_robot(0.0), 0),
        (built_in("two_wheel_robot"), 0),
        (built_in("cargo_robot"), 0),
    ],
)
def test_wheels_that_turn_a_robot_faster_in_gazebo_are_told_once(robot, told):
    differences = load(ground() + robot).diagnostics.differences
    said = [each for each in differences if "are cylinders, 0.03 m wide; in Gazebo" in each]
    assert len(said) == told
    assert all("turns 14% faster there" in each for each in said)
