"""ApplyLinkWrench and KineticEnergyMonitor: external forces, and the energy lost in a crash."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.msgs.entity_pb2 import Entity
from gz_course.sim.gz.msgs.entity_wrench_pb2 import EntityWrench
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.systems.motion_world import link, plugin, world

BOX = f"<model name='box'><pose>0 0 5 0 0 0</pose>{link('l', '0 0 0 0 0 0', mass=2.0)}{{}}</model>"


def pushed(inside: str = "", model: str = "") -> World:
    return world(plugin("ApplyLinkWrench", inside) + BOX.format(model), gravity="0 0 0")


def wrench(name: str, force: Any = (0, 0, 0), torque: Any = (0, 0, 0), offset: Any = (0, 0, 0), kind: Any = 3) -> Any:
    message = EntityWrench()
    message.entity.name, message.entity.type = name, kind
    for vector, values in (
        (message.wrench.force, force),
        (message.wrench.torque, torque),
        (message.wrench.force_offset, offset),
    ):
        vector.x, vector.y, vector.z = values
    return message


def test_a_push_acts_for_one_step(node: Node) -> None:
    made = pushed()
    made.attach(node)
    node.advertise("/world/w/wrench", EntityWrench).publish(wrench("box::l", (4.0, 0, 0)))
    made.step(10)
    assert made.truth.velocity("box").linear == pytest.approx((4.0 / 2.0 * 0.001, 0, 0))


def test_a_persistent_push_acts_until_it_is_cleared_and_not_after_a_reset(node: Node) -> None:
    made = pushed()
    made.attach(node)
    node.advertise("/world/w/wrench/persistent", EntityWrench).publish(wrench("box", (4.0, 0, 0), kind=Entity.MODEL))
    made.step(500)
    made.editor.spawn("<sdf version='1.10'><model name='other'><pose>9 9 9 0 0 0</pose><link name='l'/></model></sdf>")
    made.step(500)
    assert made.truth.velocity("box").linear[0] == pytest.approx(2.0, rel=1e-6)
    number = made.entities.number("link", "box", "l")
    node.advertise("/world/w/wrench/clear", Entity).publish(Entity(id=number))
    made.step(500)
    assert made.truth.velocity("box").linear[0] == pytest.approx(2.0, rel=1e-6)
    made.reset()
    made.step(10)
    assert not made.truth.velocity("box").linear.any()


def test_wrenches_of_the_file_and_levers(node: Node) -> None:
    inside = """<persistent><entity_name>box</entity_name><entity_type>model</entity_type><torque>0 0 0.08</torque>
      </persistent><persistent><entity_name>box</entity_name></persistent>"""
    made = pushed(inside)
    assert ["<entity_type>" in text for text in made.warnings] == [True]
    made.attach(node)
    made.step(1000)
    assert made.truth.velocity("box").angular == pytest.approx((0, 0, 1.0), rel=1e-6)
    before = made.truth.velocity("box").angular[2]
    turned = made.truth.pose("box").yaw() + 0.001
    side = (math.cos(turned + math.pi / 2), math.sin(turned + math.pi / 2), 0.0)
    node.advertise("/world/w/wrench", EntityWrench).publish(wrench("box::l", side, offset=(2.0, 0, 0)))
    made.step(1)
    assert made.truth.velocity("box").angular[2] - before == pytest.approx((2.0 + 0.08) / 0.08 * 0.001, rel=1e-3)


def test_what_makes_no_sense_is_dropped(node: Node) -> None:
    made = pushed()
    made.attach(node)
    publisher = node.advertise("/world/w/wrench", EntityWrench)
    publisher.publish(wrench("box::l", (math.nan, 0, 0)))
    publisher.publish(wrench("bx::l", (1, 0, 0)))
    publisher.publish(EntityWrench())
    made.step(10)
    assert made.dropped_commands == {"/world/w/wrench": 1}
    assert any("did you mean 'box'" in text for text in made.warnings)
    assert any("lacks an entity" in text for text in made.warnings)
    assert not made.data.qvel.any()
    with pytest.raises(SdfError, match="directly in the <world>"):
        world(BOX.format(plugin("ApplyLinkWrench")))


def test_a_crash_is_told_with_the_energy_it_took(node: Node) -> None:
    ground = """<model name='g'><static>1</static><link name='l'><collision name='c'><geometry><plane/></geometry>
      </collision></link></model>"""
    ball = "<collision name='c'><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link>"
    monitor = plugin(
        "KineticEnergyMonitor", "<link_name>l</link_name><kinetic_energy_threshold>5</kinetic_energy_threshold>"
    )
    made = world(ground + BOX.format(monitor).replace("</link>", ball, 1).replace("0 0 5 0", "0 0 1.1 0"))
    made.attach(node)
    heard: list[Any] = []
    node.subscribe(Double, "/model/box/kinetic_energy", lambda message: heard.append(message.data))
    made.step(440)
    assert heard == []
    made.step(500)
    # It falls 1 m: 2 kg * 9.8 m/s^2 * 1 m, most of which is lost in a few steps.
    assert 10.0 < sum(heard) <= 19.7


def test_energy_is_that_of_motion_and_turning(node: Node) -> None:
    monitor = plugin("KineticEnergyMonitor", "<link_name>l</link_name>")
    made = world(BOX.format(monitor), gravity="0 0 0")
    made.data.qvel[:] = (1.0, 2.0, 0.0, 0.0, 0.0, 3.0)
    system: Any = list(made.systems)[-1]
    assert system.energy() == pytest.approx(0.5 * 2.0 * 5.0 + 0.5 * 0.08 * 9.0)
    assert np.isfinite(made.data.qpos).all()
    with pytest.raises(SdfError, match="needs a <link_name>"):
        world(BOX.format(plugin("KineticEnergyMonitor")))
