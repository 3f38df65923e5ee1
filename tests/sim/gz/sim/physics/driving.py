"""Measures how well a wheeled robot follows its commands; used by the proofs and the benchmark."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gz_course.sim.gz.sim.world import World
from gz_course.tests.sim.gz.sim.physics.wheeled_robots import WheeledRobot, drive_of

SPEED, TURN = 0.5, 0.1


@dataclass(frozen=True)
class Driving:
    """Errors as fractions, times [s], lengths [m], angles [rad]."""

    speed_error: float
    """Largest error of 0.5 m/s from half a second after the command on."""
    turn_error: float
    """The same for 0.1 rad/s."""
    settled: float
    """When both errors stay below 0.5 %."""
    stop: float
    """Way from the command to stop until it stands."""
    drift: float
    """Sideways after 10 m straight on."""
    spin_error: float
    """Error of 1 rad/s on the spot."""


def steps(world: World, seconds: float) -> int:
    return round(seconds * 1e9 / world.step_size_ns)


def forward_speed(world: World) -> float:
    velocity, yaw = world.truth.velocity("robot"), world.truth.pose("robot").yaw()
    return float(velocity.linear[0] * math.cos(yaw) + velocity.linear[1] * math.sin(yaw))


def measure(robot: WheeledRobot, step: float) -> Driving:
    """Drive a robot from rest with step commands, without limits of acceleration."""
    world = robot.world(step)
    drive = drive_of(world)
    world.step(steps(world, 0.5))
    drive.command(SPEED, TURN)
    tick, settled = 0.02, 0.0
    worst = [0.0, 0.0]
    for number in range(1, 151):
        world.step(steps(world, tick))
        errors = [abs(forward_speed(world) / SPEED - 1.0), abs(world.truth.velocity("robot").angular[2] / TURN - 1.0)]
        if max(errors) > 0.005:
            settled = number * tick
        if number * tick >= 0.5:
            worst = [max(old, new) for old, new in zip(worst, errors, strict=True)]
    start = world.truth.pose("robot").position
    drive.command(0.0, 0.0)
    world.step(steps(world, 1.0))
    stop = float(np.linalg.norm(world.truth.pose("robot").position - start))
    before = world.truth.pose("robot")
    drive.command(SPEED, 0.0)
    world.step(steps(world, 10.0 / SPEED))
    drift = float((before.inverse() * world.truth.pose("robot")).position[1])
    drive.command(0.0, 1.0)
    world.step(steps(world, 1.5))
    turned = world.truth.pose("robot").yaw()
    world.step(steps(world, 2.0))
    spin = (world.truth.pose("robot").yaw() - turned) % (2 * math.pi) / 2.0 - 1.0
    return Driving(worst[0], worst[1], settled, stop, abs(drift), abs(spin))


@dataclass(frozen=True)
class Endurance:
    """The results of a long drive.

    `distance` [m], the largest `tilt` [rad] and `bounce` [m] of the height, the final error of the wheel odometry as a
    fraction of the distance, and the number of MuJoCo's warnings.
    """

    distance: float
    tilt: float
    bounce: float
    odometry_error: float
    warnings: int


LIMITS = "<max_linear_acceleration>1</max_linear_acceleration><min_linear_acceleration>-1</min_linear_acceleration>"
LIMITS += (
    "<max_angular_acceleration>2</max_angular_acceleration><min_angular_acceleration>-2</min_angular_acceleration>"
)


def endure(robot: WheeledRobot, step: float, seconds: float, seed: int = 1) -> Endurance:
    """Drive with random commands, a new one every second, within the acceleration limits of real robots."""
    world = robot.world(step, drive=LIMITS)
    drive, random = drive_of(world), np.random.default_rng(seed)
    world.step(steps(world, 0.5))
    start = world.truth.pose("robot")
    distance = tilt = 0.0
    heights: list[float] = []
    last = start.position
    for _ in range(round(seconds)):
        drive.command(float(random.uniform(-0.5, 0.8)), float(random.uniform(-1.0, 1.0)))
        for _ in range(10):
            world.step(steps(world, 0.1))
            pose = world.truth.pose("robot")
            distance += float(np.linalg.norm(pose.position - last))
            tilt = max(tilt, *map(abs, pose.rpy()[:2]))
            heights.append(float(pose.position[2]))
            last = pose.position
    moved = (start.inverse() * world.truth.pose("robot")).position
    odometry = drive._odometry
    error = math.hypot(odometry.x - moved[0], odometry.y - moved[1])
    return Endurance(distance, tilt, float(np.ptp(heights)), error / distance, int(sum(world.data.warning.number)))
