"""AckermannSteering: a car follows the commanded circle, and its odometry agrees."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.msgs.actuators_pb2 import Actuators
from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.systems.ackermann_steering import AckermannSteering
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.systems.motion_world import plugin, world

BASE, TRACK, RADIUS = 0.8, 0.6, 0.15


def wheel(name: str, x: float, y: float) -> str:
    return f"""<link name='{name}'><pose>{x} {y} {RADIUS} -1.5707963267948966 0 0</pose><inertial><mass>2</mass>
      <inertia><ixx>0.013</ixx><iyy>0.013</iyy><izz>0.0225</izz></inertia></inertial>
      <collision name='c'><geometry><sphere><radius>{RADIUS}</radius></sphere></geometry></collision></link>"""


def turns(name: str, parent: str, child: str, axis: str) -> str:
    return f"""<joint name='{name}' type='revolute'><parent>{parent}</parent><child>{child}</child>
      <axis><xyz expressed_in='__model__'>{axis}</xyz></axis></joint>"""


def car(drive: str = "") -> str:
    rear = "".join(
        wheel(f"rear_{side}", 0.0, y) + turns(f"rear_{side}_joint", "body", f"rear_{side}", "0 1 0")
        for side, y in (("left", TRACK / 2), ("right", -TRACK / 2))
    )
    front = "".join(
        f"""<link name='fork_{side}'><pose>{BASE} {y} {RADIUS} 0 0 0</pose><inertial><mass>1</mass><inertia>
        <ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial></link>"""
        + turns(f"steer_{side}", "body", f"fork_{side}", "0 0 1")
        + wheel(f"front_{side}", BASE, y)
        + turns(f"front_{side}_joint", f"fork_{side}", f"front_{side}", "0 1 0")
        for side, y in (("left", TRACK / 2), ("right", -TRACK / 2))
    )
    inside = f"""<left_joint>rear_left_joint</left_joint><right_joint>rear_right_joint</right_joint>
      <left_steering_joint>steer_left</left_steering_joint><right_steering_joint>steer_right</right_steering_joint>
      <kingpin_width>{TRACK}</kingpin_width><wheel_separation>{TRACK}</wheel_separation>
      <wheel_base>{BASE}</wheel_base><wheel_radius>{RADIUS}</wheel_radius><steering_limit>0.6</steering_limit>{drive}"""
    return f"""<include><uri>model://ground_plane</uri></include><model name='car'>
      <link name='body'><pose>{BASE / 2} 0 0.25 0 0 0</pose><inertial><mass>30</mass><inertia><ixx>1</ixx>
        <iyy>3</iyy><izz>3.5</izz></inertia></inertial></link>{rear}{front}
      {plugin("AckermannSteering", inside)}</model>"""


def drive_of(made: World) -> AckermannSteering:
    return next(system for system in made.systems if isinstance(system, AckermannSteering))


def steering(made: World) -> tuple[float, float]:
    left, right = (made.data.joint(f"car::steer_{side}").qpos[0] for side in ("left", "right"))
    return float(left), float(right)


@pytest.mark.parametrize(("speed", "rate"), [(0.8, 0.3), (0.8, -0.3), (-0.5, 0.2), (1.0, 0.0)])
def test_the_car_drives_along_its_circle(speed: float, rate: float) -> None:
    made = world(car(), step=0.002)
    drive_of(made).command(speed, rate)
    made.step(4000)
    before = made.truth.pose("car")
    made.step(500)
    after = made.truth.pose("car")
    turned = math.remainder(after.yaw() - before.yaw(), 2 * math.pi)
    assert turned == pytest.approx(rate, rel=0.02, abs=1e-3)
    chord = abs(speed) if rate == 0 else abs(2 * speed / rate * math.sin(rate / 2))
    assert np.linalg.norm(after.position - before.position) == pytest.approx(chord, rel=0.01)
    assert not any(made.data.warning.number)


def test_the_inner_wheel_steers_more_and_no_wheel_beyond_the_limit() -> None:
    made = world(car("<steer_p_gain>5</steer_p_gain>"), step=0.002)
    drive_of(made).command(0.5, 0.25)
    made.step(2000)
    radius = 0.5 / 0.25
    left, right = steering(made)
    assert left == pytest.approx(math.atan(BASE / (radius - TRACK / 2)), rel=0.01)
    assert right == pytest.approx(math.atan(BASE / (radius + TRACK / 2)), rel=0.01)
    drive_of(made).command(0.2, -5.0)
    made.step(2000)
    smallest = BASE / math.sin(0.6)
    left, right = steering(made)
    assert right == pytest.approx(-math.atan(BASE / (smallest - TRACK / 2)), rel=0.01)


def test_odometry_follows(node: Node) -> None:
    made = world(car("<max_acceleration>1</max_acceleration>"), step=0.002)
    made.attach(node)
    heard: list[Any] = []
    node.subscribe(Odometry, "/model/car/odometry", heard.append)
    command = Twist()
    command.linear.x, command.angular.z = 0.8, 0.3
    node.advertise("/model/car/cmd_vel", Twist).publish(command)
    made.step(3000)
    last, truth = heard[-1], made.truth.pose("car")
    assert {entry.key: entry.value[0] for entry in last.header.data} == {
        "frame_id": "car/odom",
        "child_frame_id": "car/body",
    }
    assert last.twist.linear.x == pytest.approx(0.8, rel=0.01)
    assert last.twist.angular.z == pytest.approx(0.3, rel=0.03)
    away = math.hypot(last.pose.position.x - truth.position[0], last.pose.position.y - truth.position[1])
    assert 0.0 < away < 0.1
    made.reset()
    made.step(20)
    assert heard[-1].pose.position.x == pytest.approx(0.0, abs=1e-6)


def test_steering_only_by_angle_or_by_actuators(node: Node) -> None:
    only = "<steering_only>true</steering_only><steer_p_gain>10</steer_p_gain>"
    made = world(car(only), step=0.002)
    made.attach(node)
    node.advertise("/model/car/steer_angle", Double).publish(Double(data=0.3))
    made.step(1000)
    left, right = steering(made)
    assert right < 0.3 < left
    # The axles of both wheels intersect on the line of the rear axle.
    assert BASE / math.tan(left) + TRACK / 2 == pytest.approx(BASE / math.tan(right) - TRACK / 2, rel=0.01)
    numbered = only + "<use_actuator_msg>1</use_actuator_msg><actuator_number>1</actuator_number>"
    other = world(car(numbered), step=0.002)
    drive = drive_of(other)
    assert drive.command_topic == "/actuators"
    drive._on_actuators(Actuators(position=[0.0, -0.2]))
    other.step(1000)
    assert np.mean(steering(other)) == pytest.approx(-0.2, rel=0.02)


@pytest.mark.parametrize("bad", [(math.nan, 0.0), (0.0, math.inf)])
def test_commands_that_are_not_finite_are_dropped(bad: tuple[float, float]) -> None:
    made = world(car(), step=0.002)
    assert not drive_of(made).command(*bad)
    drive_of(made).command(1e300, -1e300)
    made.step(500)
    assert list(made.dropped_commands.values()) == [1]
    assert np.isfinite(made.data.qpos).all() and not any(made.data.warning.number)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("<left_steering_joint>steer_left<", "<left_steering_joint>ster_left<", "did you mean 'steer_left'"),
        ("<right_joint>rear_right_joint</right_joint>", "", "at least one <right_joint>"),
        ("<wheel_base>0.8<", "<wheel_base>0<", "must be greater than zero"),
    ],
)
def test_wrong_parameters_are_refused_at_their_line(old: str, new: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence):
        world(car().replace(old, new))
