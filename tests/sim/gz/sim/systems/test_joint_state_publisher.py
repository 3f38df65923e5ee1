"""JointStatePublisher: the values are those of MuJoCo, for every kind of joint."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.msgs.model_pb2 import Model
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.systems.motion_world import arm, joint, link, plugin, world

DRIVEN = plugin("JointController", "<joint_name>elbow</joint_name><initial_velocity>0.3</initial_velocity>")


def publisher(inside: str = "") -> str:
    return plugin("JointStatePublisher", inside)


def listen(node: Node, made: World, topic: str) -> list[Any]:
    made.attach(node)
    heard: list[Any] = []
    node.subscribe(Model, topic, heard.append)
    return heard


def test_position_velocity_and_force_of_every_joint_after_every_step(node: Node) -> None:
    limits = "<limit><lower>-1</lower><upper>2</upper></limit><dynamics><damping>0.4</damping></dynamics>"
    made = world(arm(DRIVEN + publisher(), elbow=limits))
    heard = listen(node, made, "/world/w/model/arm/joint_state")
    made.step(250)
    assert len(heard) == 250
    last = heard[-1]
    assert (last.header.stamp.sec, last.header.stamp.nsec) == (0, 250_000_000)
    assert last.name == "arm" and last.id == made.entities.number("model", "arm")
    assert [each.name for each in last.joint] == ["fix", "shoulder", "elbow"]
    fixed, shoulder, elbow = last.joint
    assert not fixed.HasField("axis1")
    data = made.data
    for message, name in ((shoulder, "arm::shoulder"), (elbow, "arm::elbow")):
        assert message.axis1.position == data.joint(name).qpos[0]
        assert message.axis1.velocity == data.joint(name).qvel[0]
        assert message.axis1.force == data.qfrc_actuator[made.model.joint(name).dofadr[0]]
    assert elbow.axis1.velocity == pytest.approx(0.3, rel=1e-3) and abs(elbow.axis1.force) > 1.0
    assert (elbow.parent, elbow.child, elbow.id) == ("upper", "lower", made.entities.number("joint", "arm", "elbow"))
    assert (elbow.axis1.limit_lower, elbow.axis1.limit_upper, elbow.axis1.damping) == (-1.0, 2.0, 0.4)
    assert (shoulder.axis1.limit_lower, shoulder.axis1.limit_upper) == (-math.inf, math.inf)
    assert (shoulder.axis1.xyz.x, shoulder.axis1.xyz.y, shoulder.axis1.xyz.z) == (0.0, 1.0, 0.0)
    assert heard[0].joint[2].axis1.position < heard[-1].joint[2].axis1.position


def test_prismatic_universal_ball_and_screw(node: Node) -> None:
    two = "<axis><xyz>1 0 0</xyz></axis><axis2><xyz>0 1 0</xyz></axis2>"
    bodies = link("base", "0 0 0 0 0 0") + "".join(link(f"l{n}", f"{n} 0 1 0 0 0") for n in range(4))
    joints = joint("fix", "fixed", "world", "base") + joint("slide", "prismatic", "base", "l0", "<xyz>0 0 1</xyz>")
    joints += joint("cross", "universal", "base", "l1").replace("<axis><xyz>0 1 0</xyz></axis>", two)
    joints += joint("ball", "ball", "base", "l2").replace("<axis><xyz>0 1 0</xyz></axis>", "")
    joints += joint("screw", "screw", "base", "l3", "<xyz>0 0 1</xyz>")
    made = world(f"<model name='m'>{bodies}{joints}{publisher()}</model>", gravity="0 0 0")
    heard = listen(node, made, "/world/w/model/m/joint_state")
    made.data.joint("m::slide").qvel[:] = 0.5
    made.data.joint("m::cross").qvel[:] = 0.1
    made.data.joint("m::cross#2").qvel[:] = -0.2
    made.data.joint("m::ball").qvel[:] = (0.0, 0.7, 0.0)
    made.data.joint("m::screw").qvel[:] = 1.0
    made.step(1000)
    by_name = {each.name: each for each in heard[-1].joint}
    assert by_name["slide"].axis1.position == pytest.approx(0.5, rel=1e-3)
    assert by_name["cross"].axis1.position == pytest.approx(0.1, rel=0.1)
    assert by_name["cross"].axis2.position == pytest.approx(-0.2, rel=0.1)
    assert by_name["ball"].axis1.position == pytest.approx(0.0, abs=1e-3)
    assert by_name["ball"].axis2.position == pytest.approx(0.7, rel=1e-2)
    assert by_name["screw"].axis1.position == made.data.joint("m::screw").qpos[0] > 0.1


def test_chosen_joints_topic_and_rate(node: Node) -> None:
    inside = "<joint_name>elbow</joint_name><topic>state of it</topic><update_rate>50</update_rate>"
    made = world(arm(publisher(inside + "<joint_name>knee</joint_name>")))
    heard = listen(node, made, "/state_of_it")
    made.step(100)
    assert [each.name for each in heard[0].joint] == ["elbow"]
    assert [each.header.stamp.nsec for each in heard] == [20_000_000 * n for n in range(1, 6)]
    assert ["names joint 'knee'" in text for text in made.warnings] == [True]


def test_a_nested_model_reports_its_own_joints_and_where_it_is(node: Node) -> None:
    inner = arm(publisher(), name="inner").replace(joint("fix", "fixed", "world", "base"), "")
    inner = inner.replace("<model name='inner'>", "<model name='inner'><pose>0 2 0 0 0 0</pose>")
    made = world(
        f"<model name='outer'><pose>5 0 0 0 0 0</pose>{link('root', '0 0 0 0 0 0')}"
        f"{joint('fix', 'fixed', 'world', 'root')}{inner}{joint('mount', 'fixed', 'root', 'inner::base')}"
        f"{publisher()}</model>"
    )
    inside = listen(node, made, "/world/w/model/outer/model/inner/joint_state")
    outside: list[Any] = []
    node.subscribe(Model, "/world/w/model/outer/joint_state", outside.append)
    made.step(2)
    assert inside[-1].name == "inner" and inside[-1].id == made.entities.number("model", "outer", "inner")
    assert [each.name for each in inside[-1].joint] == ["shoulder", "elbow"]
    assert [each.child for each in inside[-1].joint] == ["upper", "lower"]
    assert (inside[-1].pose.position.x, inside[-1].pose.position.y) == pytest.approx((0.0, 2.0))
    assert [each.name for each in outside[-1].joint] == ["fix", "mount"]
    assert outside[-1].pose.position.x == pytest.approx(5.0)


def test_a_free_model_is_reported_where_it_is(node: Node) -> None:
    made = world(f"<model name='m'><pose>1 2 3 0 0 0</pose>{link('l', '0 0 0 0 0 0')}{publisher()}</model>")
    heard = listen(node, made, "/world/w/model/m/joint_state")
    made.step(500)
    position = heard[-1].pose.position
    assert np.array((position.x, position.y, position.z)) == pytest.approx(made.truth.pose("m").position)
    assert position.z < 2.0


def test_nothing_is_made_while_nobody_listens(node: Node) -> None:
    made = world(arm(publisher()))
    made.attach(node)
    system = list(made.systems)[-1]
    system._message = None  # type: ignore[attr-defined]  # creating a message now fails
    made.step(10)
