"""Hydrodynamics: damping, added mass, Coriolis forces and currents."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gz_course.sim.gz.msgs.vector3d_pb2 import Vector3d
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.systems.floating_world import body
from gz_course.tests.sim.gz.sim.systems.motion_world import plugin, world

PUSHED = "<persistent><entity_name>a</entity_name><entity_type>model</entity_type><force>40 0 0</force></persistent>"


def water(inside: str, *, force: bool = False, pose: str = "0 0 0 0 0 0") -> World:
    vessel = body(pose=pose, plugins=plugin("Hydrodynamics", f"<link_name>l</link_name>{inside}"))
    made = world((plugin("ApplyLinkWrench", PUSHED) if force else "") + vessel, gravity="0 0 0")
    assert not made.warnings
    return made


def test_linear_and_quadratic_damping_slow_down_as_computed() -> None:
    made = water("<xU>-5</xU><yVabsV>-20</yVabsV><zWW>-1</zWW>", pose="0 0 0 0 0 1.5707963267948966")
    made.data.qvel[:3] = (1.0, 1.0, 0.0)  # the vessel looks along y
    made.step(500)
    assert made.data.qvel[1] == pytest.approx(math.exp(-5.0 / 10.0 * 0.5), rel=1e-3)
    assert made.data.qvel[0] == pytest.approx(1.0 / (1.0 + 20.0 / 10.0 * 0.5), rel=1e-3)


def test_an_added_mass_above_that_of_the_body_is_stable() -> None:
    made = water("<xDotU>-30</xDotU><xU>-8</xU>", force=True)
    made.step(1500)
    assert made.data.qvel[0] == pytest.approx(40 / 8 * (1 - math.exp(-8 / 40 * 1.5)), rel=2e-3)
    made = water("<xDotU>-30</xDotU><disable_added_mass>true</disable_added_mass>", force=True)
    made.step(100)
    assert made.data.qvel[0] == pytest.approx(40 / 10 * 0.1, rel=1e-3)


def test_the_added_mass_has_the_coriolis_forces_of_gazebo() -> None:
    added = "<xDotU>-2</xDotU><yDotV>-4</yDotV><zDotW>-6</zDotW><nDotR>-1</nDotR>"
    made = water(added + "<disable_added_mass>1</disable_added_mass>")
    (u, v, w), (p, q, r) = (1.0, 2.0, 3.0), (0.1, 0.2, 0.3)
    made.data.qvel[:] = (u, v, w, p, q, r)
    made.step(1)
    force = (6 * w * q + 4 * v * r, -6 * w * p + 2 * u * r, 4 * v * p - 2 * u * q)
    torque = (6 * w * v - 4 * v * w + r * q, -6 * w * u + 2 * u * w - r * p, -4 * v * u - 2 * u * v)
    assert made.data.xfrc_applied[1] == pytest.approx((*force, *torque))
    made = water(added + "<disable_added_mass>1</disable_added_mass><disable_coriolis>1</disable_coriolis>")
    made.data.qvel[:] = 1.0
    made.step(1)
    assert not made.data.xfrc_applied.any()


def test_a_current_takes_the_body_along(node: Node) -> None:
    made = water("<xU>-50</xU><yV>-50</yV><default_current>0.5 0 0</default_current><namespace>n</namespace>")
    made.attach(node)
    made.step(1500)
    assert made.data.qvel[:2] == pytest.approx((0.5, 0.0), abs=1e-3)
    node.advertise("/model/n/ocean_current", Vector3d).publish(Vector3d(y=0.3))
    made.step(1500)
    assert made.data.qvel[:2] == pytest.approx((0.0, 0.3), abs=1e-3)
    assert np.abs(made.data.qvel[2:]).max() < 1e-9


def test_a_link_is_needed() -> None:
    with pytest.raises(SdfError, match="Hydrodynamics needs a <link_name>"):
        world(body(plugins=plugin("Hydrodynamics")))
    made = world(body(plugins=plugin("Hydrodynamics", "<link_name>l</link_name><xUabsu>1</xUabsu>")))
    assert "has no parameter <xUabsu>" in made.warnings[0]
