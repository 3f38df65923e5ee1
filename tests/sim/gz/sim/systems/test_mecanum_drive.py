"""MecanumDrive: the model goes forward, sideways and round as it is told."""

from __future__ import annotations

import math
from typing import Any

import mujoco
import pytest

from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.systems.motion_world import joint, plugin, world

NAMES = {"front_left": (0.75, 0.6), "front_right": (0.75, -0.6), "back_left": (-0.75, 0.6), "back_right": (-0.75, -0.6)}
GROUND = "<include><uri>model://ground_plane</uri></include>"
SIZES = "<wheel_separation>1.2</wheel_separation><wheelbase>1.5</wheelbase><wheel_radius>0.3</wheel_radius>"
JOINTS = "".join(f"<{name}_joint>{name}</{name}_joint>" for name in NAMES)


def part(name: str, pose: str, mass: float, inside: str = "") -> str:
    moments = "".join(f"<{axis}>{mass / 20}</{axis}>" for axis in ("ixx", "iyy", "izz"))
    inertial = f"<inertial><mass>{mass}</mass><inertia>{moments}</inertia></inertial>"
    return f"<link name='{name}'><pose>{pose}</pose>{inertial}{inside}</link>"


def car(inside: str = JOINTS + SIZES, yaw: float = 0.0) -> World:
    ball = "<collision name='c'><geometry><sphere><radius>0.3</radius></sphere></geometry></collision>"
    wheels = "".join(
        part(f"{name}_wheel", f"{x} {y} 0 -1.5707963267948966 0 0", 2.0, ball)
        + joint(name, "revolute", "chassis", f"{name}_wheel", "<xyz>0 0 1</xyz>")
        for name, (x, y) in NAMES.items()
    )
    text = f"<model name='car'><pose>0 0 0.3 0 0 {yaw}</pose>{part('chassis', '0 0 0 0 0 0', 10.0)}{wheels}"
    return world(f"{GROUND}{text}{plugin('MecanumDrive', inside)}</model>", step=0.004)


def drive(made: World) -> Any:
    return next(each for each in made.systems if each.name == "MecanumDrive")


def own_velocity(made: World) -> tuple[float, float, float]:
    """Return the velocity forward and sideways [m/s] and the yaw rate [rad/s]."""
    velocity, yaw = made.truth.velocity("car"), made.truth.pose("car").yaw()
    x, y, _ = velocity.linear.tolist()
    turning = velocity.angular.item(2)
    return x * math.cos(yaw) + y * math.sin(yaw), y * math.cos(yaw) - x * math.sin(yaw), turning


@pytest.mark.parametrize("command", [(0.5, 0.0, 0.0), (0.0, 0.5, 0.0), (0.3, -0.4, 0.5)])
def test_the_model_moves_as_commanded(command: tuple[float, float, float]) -> None:
    made = car(yaw=0.5)
    assert not made.warnings
    drive(made).command(*command)
    made.step(150)
    assert own_velocity(made) == pytest.approx(command, abs=2e-3)
    assert made.truth.pose("car").position[2] == pytest.approx(0.3, abs=1e-3)


def test_limits_odometry_and_topics(node: Node) -> None:
    limits = "<max_acceleration>2</max_acceleration><min_acceleration>-2</min_acceleration>"
    made = car(JOINTS + SIZES + limits)
    made.attach(node)
    heard: list[Any] = []
    node.subscribe(Odometry, "/model/car/odometry", heard.append)
    twist = Twist()
    twist.linear.y, twist.angular.z = 0.6, 0.4
    command = node.advertise("/model/car/cmd_vel", Twist)
    command.publish(twist)
    made.step(38)
    assert own_velocity(made)[1] == pytest.approx(0.3, abs=0.02), "after 0.15 s at 2 m/s^2"
    made.step(212)
    odometry, pose = heard[-1], made.truth.pose("car")
    assert (odometry.twist.linear.x, odometry.twist.linear.y) == pytest.approx((0.0, 0.6), abs=5e-3)
    assert odometry.twist.angular.z == pytest.approx(0.4, abs=5e-3)
    at = odometry.pose.position
    assert (at.x, at.y) == pytest.approx(pose.position[:2], abs=0.02)
    assert 2 * math.asin(odometry.pose.orientation.z) == pytest.approx(pose.yaw(), abs=0.02)
    twist.linear.y = math.inf
    command.publish(twist)
    assert made.dropped_commands == {"/model/car/cmd_vel": 1}
    made.reset()
    made.step(5)
    assert abs(made.data.qvel).max() < 0.05


def test_the_integrator_is_the_one_that_moves_surfaces() -> None:
    made = car()
    assert made.model.opt.integrator == mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    made.editor.spawn("<sdf version='1.10'><model name='other'><pose>9 9 9 0 0 0</pose><link name='l'/></model></sdf>")
    drive(made).command(0.0, 0.5, 0.0)
    made.step(100)
    assert own_velocity(made)[1] == pytest.approx(0.5, abs=2e-3)


def test_joints_are_needed() -> None:
    with pytest.raises(SdfError, match="MecanumDrive needs at least one <back_right_joint>"):
        car(JOINTS.replace("<back_right_joint>back_right</back_right_joint>", ""))
    with pytest.raises(
        SdfError, match=r"names 'front_lift', which is not a revolute joint .* did you mean 'front_left'"
    ):
        car(JOINTS.replace(">front_left<", ">front_lift<"))
    with pytest.raises(SdfError, match="<wheelbase> must be greater than zero, got -1"):
        car(JOINTS + "<wheelbase>-1</wheelbase>")
