"""VelocityControl: a model moves with the commanded velocity in its own axes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.systems.velocity_control import VelocityControl
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.systems.motion_world import arm, joint, link, plugin, world


def box(inside: str = "", more: str = "", pose: str = "0 0 5 0 0 0.5") -> str:
    links = link("l", "0 0 0 0 0 0") + more
    return f"<model name='box'><pose>{pose}</pose>{links}{plugin('VelocityControl', inside)}</model>"


def control(made: World) -> VelocityControl:
    return next(system for system in made.systems if isinstance(system, VelocityControl))


def twist(x: float = 0.0, y: float = 0.0, z: float = 0.0, yaw: float = 0.0) -> Any:
    message = Twist()
    message.linear.x, message.linear.y, message.linear.z, message.angular.z = x, y, z, yaw
    return message


def test_a_model_moves_along_its_own_axes_and_turns(node: Node) -> None:
    made = world(box(), gravity="0 0 0")
    made.attach(node)
    node.advertise("/model/box/cmd_vel", Twist).publish(twist(1.0, 0.0, 0.2, 0.8))
    made.step(1001)
    pose = made.truth.pose("box")
    assert pose.yaw() == pytest.approx(0.5 + 0.8, rel=1e-3)
    radius = 1.0 / 0.8
    expected = (radius * (math.sin(1.3) - math.sin(0.5)), -radius * (math.cos(1.3) - math.cos(0.5)), 5.2)
    assert pose.position == pytest.approx(expected, abs=2e-3)


def test_the_axes_are_those_of_the_model_however_its_link_stands() -> None:
    tilted = f"""<model name='box'><pose>0 0 5 0 0 0</pose>{link("l", "0 0 0 1.2 0 0.4")}
      {plugin("VelocityControl", "<initial_angular>0 0 1</initial_angular>")}</model>"""
    made = world(tilted, gravity="0 0 0")
    made.step(1000)
    assert made.truth.pose("box").yaw() == pytest.approx(1.0, rel=2e-3)
    assert made.truth.velocity("box").angular == pytest.approx((0, 0, 1), abs=5e-3)


def test_a_command_acts_one_step_later_and_holds() -> None:
    made = world(box(), gravity="0 0 0")
    control(made).command((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    made.step(1)
    assert not made.data.qvel.any()
    made.step(1)
    assert np.linalg.norm(made.data.qvel) == pytest.approx(1.0)
    made.data.qvel[:] = 7.0
    made.step(1)
    assert np.linalg.norm(made.data.qvel) == pytest.approx(1.0)


def test_without_a_command_gravity_acts_within_a_step_only() -> None:
    made = world(box())
    made.step(1000)
    assert made.truth.pose("box").position[2] == pytest.approx(5.0 - 4.9e-3, rel=1e-5)


def test_initial_velocities_come_again_after_a_reset() -> None:
    made = world(
        box("<initial_linear>0 2 0</initial_linear><initial_angular>0 0 0.1</initial_angular>"), gravity="0 0 0"
    )
    made.step(1)
    first = made.data.qvel.copy()
    assert np.linalg.norm(first[:3]) == pytest.approx(2.0) and first[5] == pytest.approx(0.1)
    control(made).command((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    made.step(10)
    assert not made.data.qvel.any()
    made.reset()
    made.step(1)
    assert made.data.qvel == pytest.approx(first)


def test_parts_that_float_apart_move_as_one_body() -> None:
    made = world(box(more=link("far", "2 0 0 0 0 0"), pose="0 0 5 0 0 0"), gravity="0 0 0")
    control(made).command((0.0, 0.0, 0.0), (0.0, 0.0, math.pi))
    made.step(1001)
    assert made.truth.link_pose("box", "l").position == pytest.approx((0, 0, 5), abs=0.02)
    assert made.truth.link_pose("box", "far").position == pytest.approx((-2, 0, 5), abs=0.02)


def test_a_link_is_moved_by_its_own_topic(node: Node) -> None:
    text = box("<link_name>far</link_name>", link("far", "2 0 0 0 0 1.5707963267948966"), "0 0 5 0 0 0")
    made = world(text, gravity="0 0 0")
    made.attach(node)
    node.advertise("/model/box/link/far/cmd_vel", Twist).publish(twist(1.0))
    made.step(1001)
    assert made.truth.link_pose("box", "far").position == pytest.approx((2, 1, 5), abs=5e-3)
    assert made.truth.link_pose("box", "l").position == pytest.approx((0, 0, 5), abs=1e-9)


def test_joints_of_a_moved_model_stay_free() -> None:
    more = link("bob", "1 0 0 0 0 0") + joint("swing", "revolute", "l", "bob", "<xyz>0 0 1</xyz>")
    made = world(box(more=more), gravity="0 0 0")
    made.data.joint("box::swing").qvel[:] = 0.5
    made.step(1)
    assert made.data.joint("box::swing").qvel[0] == pytest.approx(0.5, rel=1e-2)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_commands_that_are_not_finite_are_dropped(node: Node, bad: float) -> None:
    made = world(box("<link_name>l</link_name>"))
    made.attach(node)
    node.advertise("/model/box/cmd_vel", Twist).publish(twist(bad))
    node.advertise("/model/box/link/l/cmd_vel", Twist).publish(twist(0.0, bad))
    made.step(10)
    assert made.dropped_commands == {"/model/box/cmd_vel": 1, "/model/box/link/l/cmd_vel": 1}
    assert np.isfinite(made.data.qpos).all()


def test_absurd_commands_do_not_break_the_physics() -> None:
    made = world(box())
    control(made).command((1e300, -1e300, 0.0), (1e300, 0.0, 0.0))
    made.step(500)
    assert np.isfinite(made.data.qpos).all() and not any(made.data.warning.number)


def test_what_cannot_move_says_so() -> None:
    made = world(arm(plugin("VelocityControl", "<link_name>uper</link_name>")))
    assert ["did you mean 'upper'" in text or "held by a joint" in text for text in made.warnings] == [True, True]
    made.step(10)
