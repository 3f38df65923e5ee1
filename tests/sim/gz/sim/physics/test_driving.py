"""Robots of 1 to 140 kg follow the commands of DiffDrive at steps of 1, 2 and 4 ms."""

from __future__ import annotations

import math

import pytest

from gz_course.tests.sim.gz.sim.physics.driving import endure, measure, steps
from gz_course.tests.sim.gz.sim.physics.wheeled_robots import ROBOTS, WheeledRobot, drive_of

each_robot = pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.name.replace(" ", ""))


@each_robot
@pytest.mark.parametrize("step", [0.001, 0.002, 0.004])
def test_speed_and_rate_are_those_commanded(robot: WheeledRobot, step: float) -> None:
    seen = measure(robot, step)
    assert seen.speed_error < 0.0035 and seen.turn_error < 0.0035  # the promised 0.5 %, and the accuracy of the recipe
    assert seen.settled <= 0.5
    assert seen.stop < 0.02
    assert seen.drift < 0.005
    assert seen.spin_error < 0.01


@each_robot
def test_a_minute_of_random_commands(robot: WheeledRobot) -> None:
    seen = endure(robot, 0.004, 60.0)
    assert seen.warnings == 0
    assert seen.tilt < math.radians(2) and seen.bounce < 0.005
    # Wheels slip a little: the odometry is close to the true pose, but not equal.
    assert 1e-6 < seen.odometry_error < 0.05


@each_robot
def test_a_parked_robot_stays(robot: WheeledRobot) -> None:
    world = robot.world(0.002)
    world.step(steps(world, 0.5))
    before = world.truth.pose("robot")
    world.step(steps(world, 10.0))
    assert world.truth.pose("robot").is_close(before, 1e-5)


def test_wheel_odometry_slips_where_the_truth_does_not() -> None:
    """A step command from rest to 1 m/s makes the wheels slip: the odometry is ahead of the true position."""
    world = ROBOTS[1].world()
    world.step(500)
    drive_of(world).command(1.0, 0.0)
    world.step(2000)
    odometry, truth = drive_of(world)._odometry.x, world.truth.pose("robot").position[0]
    assert 0.03 < odometry - truth < 0.12


def test_a_robot_against_a_wall_stands_and_its_wheels_spin() -> None:
    wall = """<model name='wall'><static>true</static><pose>1 0 0.5 0 0 0</pose><link name='l'><collision name='c'>
      <geometry><box><size>0.2 4 1</size></box></geometry></collision></link></model>"""
    robot = ROBOTS[2]
    world = robot.world()
    world.editor.spawn(f"<sdf version='1.10'>{wall}</sdf>")
    drive_of(world).command(0.5, 0.0)
    world.step(4000)
    before = world.truth.pose("robot")
    world.step(2000)
    after = world.truth.pose("robot")
    assert before.position[0] < 1.0
    assert after.is_close(before, 0.02)
    assert drive_of(world)._odometry.x > 2.0
    assert not any(world.data.warning.number)
