"""JointPositionController, JointController, ApplyJointForce, JointTrajectoryController on an arm under gravity."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.msgs.actuators_pb2 import Actuators
from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.msgs.float_pb2 import Float
from gz_course.sim.gz.msgs.joint_trajectory_pb2 import JointTrajectory
from gz_course.sim.gz.sim.driving.joint_command import JointCommand
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.systems.motion_world import arm, joint, link, plugin, world

STRONG = "<p_gain>2000</p_gain><i_gain>500</i_gain><d_gain>100</d_gain><i_max>100</i_max><i_min>-100</i_min>"
LIMITS = "<limit><lower>-1</lower><upper>1</upper>{}</limit>"


def position(which: str = "shoulder", inside: str = STRONG) -> str:
    return plugin("JointPositionController", f"<joint_name>{which}</joint_name>{inside}")


def velocity(which: str = "shoulder", inside: str = "") -> str:
    return plugin("JointController", f"<joint_name>{which}</joint_name>{inside}")


def force(which: str = "shoulder") -> str:
    return plugin("ApplyJointForce", f"<joint_name>{which}</joint_name>")


def command(made: World, value: float, index: int = 0) -> bool:
    return [system for system in made.systems if isinstance(system, JointCommand)][index].command(value)


def angle(made: World, which: str = "shoulder") -> float:
    return float(made.data.joint(f"arm::{which}").qpos[0])


def speed(made: World, which: str = "shoulder") -> float:
    return float(made.data.joint(f"arm::{which}").qvel[0])


def test_position_is_reached_and_held_against_gravity(node: Node) -> None:
    made = world(arm(position() + position("elbow")))
    made.attach(node)
    node.advertise("/model/arm/joint/shoulder/0/cmd_pos", Double).publish(Double(data=-0.5))
    node.advertise("/model/arm/joint/elbow/0/cmd_pos", Double).publish(Double(data=0.3))
    made.step(4000)
    assert (angle(made), angle(made, "elbow")) == pytest.approx((-0.5, 0.3), abs=2e-3)


def test_initial_position_is_gone_to_again_after_a_reset() -> None:
    made = world(arm(position(inside=STRONG + "<initial_position>-0.4</initial_position>")))
    made.step(3000)
    assert angle(made) == pytest.approx(-0.4, abs=5e-3)
    command(made, 0.4)
    made.step(3000)
    assert angle(made) == pytest.approx(0.4, abs=5e-3)
    made.reset()
    made.step(3000)
    assert angle(made) == pytest.approx(-0.4, abs=5e-3)


def test_the_default_gains_are_those_of_gazebo() -> None:
    """With 1, 0.1, 0.01 an arm of 1 kg falls, so only the first force can be predicted."""
    made = world(arm(position(inside="")))
    command(made, 2.0)
    made.step(1)
    error = -2.0
    expected = -(1.0 * error + 0.1 * error * 0.001 + 0.01 * error / 0.001)
    assert made.data.qfrc_actuator[0] == pytest.approx(expected)


def test_positions_by_velocity_come_with_the_speed_of_cmd_max_or_at_once() -> None:
    direct = "<use_velocity_commands>true</use_velocity_commands>"
    made = world(arm(position(inside=direct + "<cmd_max>0.5</cmd_max>")))
    command(made, 1.0)
    made.step(1000)
    assert angle(made) == pytest.approx(0.5, abs=5e-3)
    assert speed(made) == pytest.approx(0.5, rel=2e-3)
    made.step(2000)
    assert angle(made) == pytest.approx(1.0, abs=1e-3)
    at_once = world(arm(position(inside=direct)))
    command(at_once, 1.0)
    at_once.step(2)
    assert angle(at_once) == pytest.approx(1.0, abs=5e-3)


@pytest.mark.parametrize("step", [0.001, 0.004])
def test_velocity_is_held_against_gravity_from_the_first_step_on(step: float) -> None:
    made = world(arm(velocity(inside="<initial_velocity>-0.5</initial_velocity>") + velocity("elbow")), step=step)
    for _ in range(20):
        made.step(round(0.1 / step))
        assert speed(made) == pytest.approx(-0.5, rel=2e-3)
        assert abs(speed(made, "elbow")) < 2e-3
    assert angle(made) == pytest.approx(-1.0, rel=5e-3)


def test_a_servo_stops_at_the_limits_of_its_joint() -> None:
    made = world(arm(velocity(), shoulder=LIMITS.format("")))
    for wanted, expected in ((3.0, 1.0), (-3.0, -1.0)):
        command(made, wanted)
        made.step(2000)
        assert angle(made) == pytest.approx(expected, abs=1e-2)
        assert abs(speed(made)) < 1e-2


def test_a_servo_keeps_to_the_speed_and_the_effort_of_its_joint() -> None:
    fast = world(arm(velocity(), shoulder="<limit><velocity>0.7</velocity></limit>"))
    command(fast, 5.0)
    fast.step(500)
    assert speed(fast) == pytest.approx(0.7, rel=5e-3)
    # 2 N m cannot hold 5 N m of gravity.
    weak = world(arm(velocity() + velocity("elbow"), shoulder="<limit><effort>2</effort></limit>"))
    weak.step(500)
    assert abs(weak.data.qfrc_actuator[0]) <= 2.0 + 1e-9
    assert angle(weak) > 0.3


def test_force_mode_is_a_pid_of_the_velocity() -> None:
    inside = "<use_force_commands>1</use_force_commands><p_gain>5</p_gain>"
    made = world(arm(velocity(inside=inside) + velocity("elbow")), gravity="0 0 0")
    command(made, 1.0)
    made.step(1)
    assert made.data.qfrc_actuator[0] == pytest.approx(5.0)
    made.step(3000)
    assert speed(made) == pytest.approx(1.0, rel=0.02)


def test_several_joints_follow_the_first(node: Node) -> None:
    both = "<joint_name>shoulder</joint_name><joint_name>elbow</joint_name><topic>/both</topic>"
    made = world(arm(plugin("JointController", both)))
    made.attach(node)
    node.advertise("/both", Double).publish(Double(data=0.2))
    made.step(100)
    assert (speed(made), speed(made, "elbow")) == pytest.approx((0.2, 0.2), rel=5e-3)


def test_actuators_message_by_number_and_sub_topic(node: Node) -> None:
    numbered = "<use_actuator_msg>true</use_actuator_msg><actuator_number>1</actuator_number>"
    sub = numbered + "<sub_topic>motors</sub_topic>"
    made = world(arm(velocity(inside=numbered) + velocity("elbow", sub)))
    made.attach(node)
    publisher = node.advertise("/actuators", Actuators)
    publisher.publish(Actuators(velocity=[9.0, 0.25]))
    node.advertise("/model/arm/motors", Actuators).publish(Actuators(velocity=[1.0, -0.5]))
    made.step(100)
    assert (speed(made), speed(made, "elbow")) == pytest.approx((0.25, -0.5), rel=5e-3)
    publisher.publish(Actuators(velocity=[1.0]))
    made.step(10)
    assert speed(made) == pytest.approx(0.25, rel=5e-3)
    assert any("holds 1 numbers in 'velocity'" in text for text in made.warnings)


def test_force_acts_on_top_and_holds(node: Node) -> None:
    made = world(arm(force()), gravity="0 0 0")
    made.attach(node)
    node.advertise("/model/arm/joint/shoulder/cmd_force", Double).publish(Double(data=0.7))
    made.step(10)
    assert made.data.qfrc_actuator[0] == pytest.approx(0.7)
    both = world(arm(velocity() + force()), gravity="0 0 0")
    command(both, 0.5, 0)
    command(both, 3.0, 1)
    both.step(200)
    assert speed(both) == pytest.approx(0.5, rel=5e-3)
    held = both.data.actuator_force
    assert held[1] == pytest.approx(3.0) and held[0] == pytest.approx(-3.0, rel=0.05)


def test_the_second_axis_of_a_universal_joint() -> None:
    axes = "<axis><xyz>1 0 0</xyz></axis><axis2><xyz>0 1 0</xyz></axis2>"
    cross = joint("cross", "universal", "base", "l").replace("<axis><xyz>0 1 0</xyz></axis>", axes)
    inside = plugin("JointPositionController", "<joint_name>cross</joint_name><joint_index>1</joint_index>" + STRONG)
    made = world(
        f"<model name='arm'>{link('base', '0 0 0 0 0 0')}{joint('fix', 'fixed', 'world', 'base')}"
        f"{link('l', '0 0 1 0 0 0')}{cross}{inside}</model>",
        gravity="0 0 0",
    )
    command(made, 0.6)
    made.step(4000)
    assert made.data.joint("arm::cross#2").qpos[0] == pytest.approx(0.6, abs=0.01)
    assert made.data.joint("arm::cross").qpos[0] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("which", [position(), velocity(), force()])
def test_commands_that_are_not_finite_never_reach_the_physics(which: str, bad: float) -> None:
    made = world(arm(which))
    assert command(made, 0.1) and not command(made, bad)
    made.step(200)
    assert list(made.dropped_commands.values()) == [1]
    assert np.isfinite(made.data.ctrl).all() and np.isfinite(made.data.qpos).all()


@pytest.mark.parametrize("which", [position(), velocity()])
def test_absurd_commands_do_not_break_the_physics(which: str) -> None:
    made = world(arm(which, shoulder=LIMITS.format("<effort>100</effort>")))
    command(made, 1e300)
    made.step(500)
    command(made, -1e300)
    made.step(500)
    assert np.isfinite(made.data.qpos).all() and not any(made.data.warning.number)


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        (position("sholder"), "did you mean 'shoulder'"),
        (velocity("fix"), "a fixed joint has no axis"),
        (position(inside="<joint_index>1</joint_index>"), "<joint_index> is 1"),
        (velocity(inside="<use_actuator_msg>1</use_actuator_msg>"), "no <actuator_number>"),
        (velocity(inside="<gain>1</gain>"), "JointController has no parameter <gain>"),
    ],
)
def test_what_does_not_fit_is_one_warning_and_the_world_runs(inside: str, sentence: str) -> None:
    made = world(arm(inside))
    assert [sentence in text for text in made.warnings] == [True]
    assert made.warnings[0].startswith("motion.sdf:")
    made.step(10)


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        (plugin("JointController"), "needs a <joint_name>"),
        (position(inside="<joint_index>-1</joint_index>"), "counts from 0"),
        (position(inside="<p_gain>much</p_gain>"), "needs a number, got 'much'"),
    ],
)
def test_wrong_parameters_are_refused_at_their_line(inside: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence):
        world(arm(inside))


def test_a_plugin_of_the_world_itself_is_refused() -> None:
    with pytest.raises(SdfError, match="belongs inside a <model>"):
        world(velocity())


def test_nested_models_are_driven_under_their_own_name(node: Node) -> None:
    inner = arm(velocity(), name="inner").replace(joint("fix", "fixed", "world", "base"), "")
    made = world(
        f"<model name='outer'>{link('root', '0 0 0 0 0 0')}{joint('fix', 'fixed', 'world', 'root')}{inner}"
        f"{joint('mount', 'fixed', 'root', 'inner::base')}{velocity('inner::elbow')}</model>"
    )
    assert made.warnings == []
    made.attach(node)
    node.advertise("/model/inner/joint/shoulder/cmd_vel", Double).publish(Double(data=0.3))
    outer = next(system for system in made.systems if isinstance(system, JointCommand) and "elbow" in system.topic)
    node.advertise(outer.topic, Double).publish(Double(data=-0.4))
    made.step(100)
    assert made.data.joint("outer::inner::shoulder").qvel[0] == pytest.approx(0.3, rel=1e-2)
    assert made.data.joint("outer::inner::elbow").qvel[0] == pytest.approx(-0.4, rel=1e-2)


TRAJECTORY = plugin(
    "JointTrajectoryController",
    "<joint_name>shoulder</joint_name><joint_name>elbow</joint_name>"
    + "<position_p_gain>500</position_p_gain><position_d_gain>30</position_d_gain>" * 2
    + "<initial_position>0.1</initial_position>",
)


def points(*rows: tuple[float, list[float]]) -> Any:
    message = JointTrajectory(joint_names=["elbow", "shoulder"])
    for time, positions in rows:
        point = message.points.add(positions=positions)
        point.time_from_start.sec, point.time_from_start.nsec = divmod(round(time * 1e9), 10**9)
    return message


def test_a_trajectory_is_followed_point_by_point(node: Node) -> None:
    made = world(arm(TRAJECTORY), gravity="0 0 0")
    made.attach(node)
    progress: list[float] = []
    node.subscribe(Float, "/model/arm/joint_trajectory_progress", lambda message: progress.append(message.data))
    made.step(1500)
    assert (angle(made), angle(made, "elbow")) == pytest.approx((0.1, 0.0), abs=5e-3)
    publisher = node.advertise("/model/arm/joint_trajectory", JointTrajectory)
    publisher.publish(points((1.5, [0.5, -0.2]), (3.0, [-0.3, 0.4])))
    made.step(1490)
    assert (angle(made), angle(made, "elbow")) == pytest.approx((-0.2, 0.5), abs=5e-3)
    assert progress == [0.5]
    made.step(15)
    assert progress == [0.5, 1.0]
    made.step(1485)
    assert (angle(made), angle(made, "elbow")) == pytest.approx((0.4, -0.3), abs=5e-3)
    assert progress == [0.5, 1.0]
    made.reset()
    made.step(1500)
    assert (angle(made), angle(made, "elbow")) == pytest.approx((0.1, 0.0), abs=5e-3)


def test_trajectories_that_make_no_sense_are_dropped(node: Node) -> None:
    made = world(arm(TRAJECTORY), gravity="0 0 0")
    made.attach(node)
    publisher = node.advertise("/model/arm/joint_trajectory", JointTrajectory)
    publisher.publish(points((0.0, [math.nan, 0.0])))
    publisher.publish(JointTrajectory())
    unknown = points((0.0, [0.0, 0.0]))
    unknown.joint_names[0] = "knee"
    publisher.publish(unknown)
    made.step(100)
    assert made.dropped_commands == {"/model/arm/joint_trajectory": 1}
    assert np.isfinite(made.data.qpos).all()
    assert ["names no joints" in text or "'knee'" in text for text in made.warnings].count(True) == 2
