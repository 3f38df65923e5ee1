"""How truly robots drive, and what the systems that move and report them cost."""

import math
import time
from collections.abc import Callable, Iterator
from typing import Any

import mujoco

from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.msgs.model_pb2 import Model
from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope
from gz_course.tests.bench.row import Row
from gz_course.tests.sim.gz.sim.physics.driving import endure, measure
from gz_course.tests.sim.gz.sim.physics.wheeled_robots import ROBOTS, drive_of
from gz_course.tests.sim.gz.sim.systems.motion_world import plugin

STEPS = 20_000
REPORTS = plugin("JointStatePublisher") + plugin("OdometryPublisher", "<odom_topic>/truth</odom_topic>")
PUSHED = plugin("ApplyJointForce", "<joint_name>left_joint</joint_name>")


def rows() -> Iterator[Row]:
    for robot in ROBOTS:
        for step in (0.001, 0.002, 0.004):
            seen = measure(robot, step)
            yield Row(
                f"robot of {robot.name}, step {step * 1e3:.0f} ms",
                f"v {seen.speed_error:.3%}, w {seen.turn_error:.3%}, settled {seen.settled:.2f} s",
                f"stop {seen.stop * 1e3:.0f} mm, 10 m: {seen.drift * 1e3:.2f} mm aside",
                f"spin {seen.spin_error:.2%}",
                "0.5 %, 0.5 s, 20 mm, 5 mm, 1 %",
            )
    for robot in ROBOTS:
        began = time.monotonic()
        lasting = endure(robot, 0.002, 600.0)
        wall = time.monotonic() - began
        yield Row(
            f"robot of {robot.name}, 10 minutes of random commands",
            f"{lasting.distance:.0f} m, tilt {math.degrees(lasting.tilt):.2f} deg, z {lasting.bounce * 1e3:.2f} mm",
            f"wheel odometry off by {lasting.odometry_error:.2%} of the way",
            f"{600.0 / wall:.0f} x real time",
            f"no warnings ({lasting.warnings})",
        )
    yield from _costs()


def _costs() -> Iterator[Row]:
    """Compare a driven robot with more and more systems with MuJoCo alone."""
    robot = ROBOTS[1]
    bare = robot.world()
    drive_of(bare).command(0.5, 0.1)
    bare.step(500)
    alone = _rate(lambda: mujoco.mj_step(bare.model, bare.data, nstep=STEPS))
    apart = (NodeOptions(partition, scope=Scope.PROCESS) for partition in ("silent", "heard"))
    with Node(next(apart)) as node, Node(next(apart)) as other:
        silent, heard = robot.world(plugins=REPORTS + PUSHED), robot.world(plugins=REPORTS + PUSHED)
        silent.attach(node)
        heard.attach(other)
        count = [0]

        def take(_: Any) -> None:
            count[0] += 1

        for kind, topic in (
            (Model, "/world/w/model/robot/joint_state"),
            (Odometry, "/truth"),
            (Odometry, "/model/robot/odometry"),
        ):
            other.subscribe(kind, topic, take)
        other.advertise("/model/robot/joint/left_joint/cmd_force", Double).publish(Double(data=0.001))
        cases: list[tuple[str, World]] = [
            ("DiffDrive alone", robot.world()),
            ("and JointStatePublisher, OdometryPublisher, ApplyJointForce, unheard", silent),
            ("the same, all heard", heard),
        ]
        for name, world in cases:
            drive_of(world).command(0.5, 0.1)
            world.step(500)
            rate = _rate(lambda world=world: world.step(STEPS))  # type: ignore[misc]
            yield Row(
                f"4 kg robot: {name}",
                f"{rate:,.0f} steps/s",
                f"mj_step: {alone:,.0f} steps/s",
                f"{rate / alone:.2f}",
                "",
            )


def _rate(run: Callable[[], None]) -> float:
    began = time.monotonic()
    run()
    return STEPS / (time.monotonic() - began)
