"""Contact sensors: the pairs that touch, positions and forces; when messages are published."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from .conftest import inertial, sensor_world

Listen = Callable[..., list[Any]]
GROUND = "<include><uri>model://ground_plane</uri></include>"
TOPIC = "/world/w/model/m/link/l/sensor/s/contact"


def box(name: str, size: str = "1 1 1", pose: str = "0 0 0 0 0 0") -> str:
    geometry = f"<geometry><box><size>{size}</size></box></geometry>"
    return f"<collision name='{name}'><pose>{pose}</pose>{geometry}</collision>"


def sensor(*collisions: str, topic: str = "", outside: str = "") -> str:
    named = "".join(f"<collision>{name}</collision>" for name in collisions)
    inside = f"<contact>{named}{f'<topic>{topic}</topic>' if topic else ''}</contact>"
    return f"<sensor name='s' type='contact'>{outside}{inside}</sensor>"


def model(parts: str, pose: str = "0 0 0.5 0 0 0", mass: float = 2.0, name: str = "m") -> str:
    return f"<model name='{name}'><pose>{pose}</pose><link name='l'>{inertial(mass)}{parts}</link></model>"


def vectors(messages: Any) -> np.ndarray[Any, Any]:
    return np.array([(each.x, each.y, each.z) for each in messages])


def test_a_box_stands_on_four_corners_that_carry_its_weight(listen: Listen) -> None:
    world = sensor_world(GROUND + model(box("c") + sensor("c")), "Contact")
    heard = listen(world, TOPIC, "gz.msgs.Contacts")
    world.step(500)
    (contact,) = heard[-1].contact
    number = world.entities.number
    assert (contact.collision1.name, contact.collision1.id) == ("m::l::c", number("collision", "m", "l", "c"))
    ground = ("ground_plane", "link", "collision")
    assert (contact.collision2.name, contact.collision2.id) == ("::".join(ground), number("collision", *ground))
    corners = sorted(vectors(contact.position)[:, :2].round(6).tolist())
    assert corners == [[-0.5, -0.5], [-0.5, 0.5], [0.5, -0.5], [0.5, 0.5]]
    assert vectors(contact.position)[:, 2] == pytest.approx([0] * 4, abs=1e-3)
    assert vectors(contact.normal) == pytest.approx(np.array([(0, 0, 1)] * 4))
    assert all(0 < depth < 1e-3 for depth in contact.depth) and len(contact.depth) == 4
    pushed = vectors([wrench.body_1_wrench.force for wrench in contact.wrench])
    assert pushed.sum(axis=0) == pytest.approx((0, 0, 2 * 9.8), abs=1e-3)
    assert vectors([wrench.body_2_wrench.force for wrench in contact.wrench]) == pytest.approx(-pushed)
    assert contact.header.stamp.nsec == heard[-1].header.stamp.nsec == 500_000_000


def test_the_other_side_feels_the_opposite(listen: Listen) -> None:
    """A static plate below the box: normal and force point down into it."""
    plate = model(box("p", "3 3 0.1") + sensor("p"), "0 0 0 0 0 0").replace("<link", "<static>1</static><link")
    world = sensor_world(plate + model(box("c"), "0 0 0.55 0 0 0", name="n"), "Contact")
    heard = listen(world, TOPIC, "gz.msgs.Contacts")
    world.step(500)
    (contact,) = heard[-1].contact
    assert (contact.collision1.name, contact.collision2.name) == ("m::l::p", "n::l::c")
    assert vectors(contact.normal) == pytest.approx(np.array([(0, 0, -1)] * 4))
    pushed = vectors([wrench.body_1_wrench.force for wrench in contact.wrench]).sum(axis=0)
    assert pushed == pytest.approx((0, 0, -2 * 9.8), abs=1e-3)


def test_a_shape_of_several_parts_is_one_collision(listen: Listen) -> None:
    corners = ((0, 0), (1, 0), (1, 0.2), (0.2, 0.2), (0.2, 1), (0, 1))
    points = "".join(f"<point>{x} {y}</point>" for x, y in corners)
    polyline = f"<geometry><polyline>{points}<height>0.1</height></polyline></geometry>"
    angle = f"<collision name='c'><pose>-0.3 -0.3 0 0 0 0</pose>{polyline}</collision>"
    world = sensor_world(GROUND + model(angle + sensor("c"), "0 0 0.05 0 0 0"), "Contact")
    assert (world.model.geom_group == 3).sum() > 2, "the ground and at least two convex parts"
    heard = listen(world, TOPIC, "gz.msgs.Contacts")
    world.step(500)
    (contact,) = heard[-1].contact
    assert (contact.collision1.name, contact.collision2.name) == ("m::l::c", "ground_plane::link::collision")
    pushed = vectors([wrench.body_1_wrench.force for wrench in contact.wrench]).sum(axis=0)
    assert len(contact.wrench) > 4 and pushed == pytest.approx((0, 0, 2 * 9.8), abs=0.05)


def test_friction_is_part_of_the_force(listen: Listen) -> None:
    angle = 0.3
    slope = (
        f"<model name='slope'><static>1</static><pose>0 0 0 0 {angle} 0</pose>"
        f"<link name='l'>{box('p', '9 9 0.1')}</link></model>"
    )
    height = 0.55
    at = f"{height * np.sin(angle)} 0 {height * np.cos(angle)} 0 {angle} 0"
    world = sensor_world(slope + model(box("c") + sensor("c"), at), "Contact")
    heard = listen(world, TOPIC, "gz.msgs.Contacts")
    world.step(500)
    (contact,) = heard[-1].contact
    assert vectors(contact.normal)[0] == pytest.approx((np.sin(angle), 0, np.cos(angle)), abs=1e-3)
    pushed = vectors([wrench.body_1_wrench.force for wrench in contact.wrench]).sum(axis=0)
    assert pushed == pytest.approx((0, 0, 2 * 9.8), abs=0.05)


def test_nothing_is_published_while_nothing_touches(listen: Listen) -> None:
    world = sensor_world(GROUND + model(box("c") + sensor("c"), "0 0 0.6 0 0 0"), "Contact")
    heard = listen(world, TOPIC, "gz.msgs.Contacts")
    world.step(100)
    assert heard == []
    world.step(200)
    # It falls 0.1 m: sqrt(2 * 0.1 / 9.8) = 0.143 s; afterwards every step has a message.
    assert 142_000_000 <= heard[0].header.stamp.nsec <= 146_000_000
    assert len(heard) > 100


def test_it_publishes_every_step_whatever_the_rate(listen: Listen) -> None:
    rated = sensor("c", outside="<update_rate>10</update_rate>")
    world = sensor_world(GROUND + model(box("c") + rated, "0 0 0.499 0 0 0"), "Contact")
    heard = listen(world, TOPIC, "gz.msgs.Contacts")
    world.step(20)
    assert len(heard) == 20
    assert world.node is not None and f"{TOPIC}/set_rate" not in world.node.service_list()


def test_only_the_named_collisions_feel(listen: Listen) -> None:
    left, right = box("left", "0.1 0.1 1", "-1 0 0 0 0 0"), box("right", "0.1 0.1 1", "1 0 0 0 0 0")
    world = sensor_world(GROUND + model(left + right + sensor("right", topic="bump")), "Contact")
    heard = listen(world, "/bump", "gz.msgs.Contacts")
    world.step(300)
    assert [contact.collision1.name for contact in heard[-1].contact] == ["m::l::right"]


def test_several_collisions_come_in_the_order_of_the_sensor(listen: Listen) -> None:
    left, right = box("left", "0.1 0.1 1", "-1 0 0 0 0 0"), box("right", "0.1 0.1 1", "1 0 0 0 0 0")
    world = sensor_world(GROUND + model(left + right + sensor("right", "left")), "Contact")
    heard = listen(world, TOPIC, "gz.msgs.Contacts")
    world.step(300)
    assert [contact.collision1.name for contact in heard[-1].contact] == ["m::l::right", "m::l::left"]


def test_a_collision_that_is_not_there_is_warned_about() -> None:
    world = sensor_world(model("\n\n" + box("bumper") + sensor("bumpr")), "Contact")
    (warning,) = world.warnings
    assert warning.startswith("<string>:3: ") and "did you mean 'bumper'" in warning
    world.step(3)


def test_a_topic_outside_of_contact_is_warned_about() -> None:
    world = sensor_world(model(box("c") + sensor("c", outside="<topic>bump</topic>")), "Contact")
    (warning,) = world.warnings
    assert "must stand in <contact>" in warning and TOPIC in warning


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        ("", "has no <contact> element; add <contact><collision>NAME</collision></contact>"),
        ("<contact/>", "names no <collision>, so it never feels anything; the collisions of its link are: c"),
    ],
)
def test_a_contact_sensor_that_feels_nothing_is_warned_about(inside: str, sentence: str) -> None:
    world = sensor_world(model(box("c") + f"<sensor name='s' type='contact'>{inside}</sensor>"), "Contact")
    (warning,) = world.warnings
    assert warning.startswith("<string>:") and sentence in warning
    world.step(3)
