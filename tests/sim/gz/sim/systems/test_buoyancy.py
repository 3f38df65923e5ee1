"""Buoyancy: Archimedes, in one fluid and between layers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.physics.displacement import Solid
from gz_course.sim.gz.sim.pose import Pose, matrix, quaternion_from_rpy, rotate
from gz_course.sim.gz.sim.sdf.description import Geometry, TriangleMesh
from gz_course.tests.sim.gz.sim.systems.floating_world import body
from gz_course.tests.sim.gz.sim.systems.motion_world import plugin, world

BALL = 4.0 / 3.0 * math.pi * 0.5**3
CYLINDER = "<cylinder><radius>0.5</radius><length>1</length></cylinder>"
SEA = """<graded_buoyancy><default_density>1000</default_density>
<density_change><above_depth>0</above_depth><density>1.125</density></density_change></graded_buoyancy>"""


def test_a_body_rises_and_sinks_with_the_difference_of_the_densities() -> None:
    models = [body(mass=mass, pose=f"{mass} 0 0 0 0 0", name=f"m{mass}") for mass in (200, 1000)]
    made = world(plugin("Buoyancy", "<uniform_fluid_density>900</uniform_fluid_density>") + "".join(models))
    assert not made.warnings
    made.step(100)
    for mass in (200, 1000):
        expected = (900 * BALL - mass) * 9.8 / mass * 0.1
        assert made.truth.velocity(f"m{mass}").linear == pytest.approx((0, 0, expected), abs=1e-9)


def test_the_force_acts_at_the_centre_of_the_volume() -> None:
    made = world(plugin("Buoyancy") + body(CYLINDER, mass=100, at="0.3 0 0 0 0 0"))
    made.step(1)
    volume = math.pi / 4.0
    assert made.truth.velocity("a").angular == pytest.approx((0, -0.3 * volume * 1000 * 9.8 / 10 * 0.001, 0), rel=1e-9)


def test_the_forces_of_all_systems_add_up() -> None:
    wrench = "<entity_name>a</entity_name><entity_type>model</entity_type><force>0 0 100</force>"
    order = [plugin("Buoyancy"), plugin("ApplyLinkWrench", f"<persistent>{wrench}</persistent>")]
    for plugins in (order, order[::-1]):
        made = world("".join(plugins) + body(mass=1000))
        made.step(10)
        expected = ((BALL * 1000 - 1000) * 9.8 + 100) / 1000 * 0.01
        assert made.truth.velocity("a").linear[2] == pytest.approx(expected)


def test_only_what_is_enabled_floats() -> None:
    models = body(name="a") + body(name="b", pose="3 0 0 0 0 0")
    made = world(plugin("Buoyancy", "<enable>b::l</enable><enable>c</enable>") + models)
    assert len(made.warnings) == 1 and "Buoyancy's <enable> names 'c', which does not exist" in made.warnings[0]
    made.step(10)
    assert made.truth.velocity("a").linear[2] == pytest.approx(-0.098)
    assert made.truth.velocity("b").linear[2] > 1.0


@pytest.mark.parametrize(
    ("shape", "mass", "z"),
    [
        ("<sphere><radius>0.5</radius></sphere>", BALL * (1000 + 1.125) / 2, 0.0),
        ("<box><size>1 1 1</size></box>", 250 + 1.125 * 0.75, 0.25),
        (CYLINDER, math.pi / 4 * (750 + 1.125 * 0.25), -0.25),
    ],
)
def test_a_body_between_water_and_air_is_at_rest_where_it_displaces_its_mass(shape: str, mass: float, z: float) -> None:
    made = world(plugin("Buoyancy", SEA) + body(shape, mass=mass, pose=f"0 0 {z} 0 0 0"))
    assert not made.warnings
    made.step(20)
    assert made.truth.velocity("a").linear == pytest.approx((0, 0, 0), abs=1e-6)
    made.editor.set_pose("a", Pose((0, 0, z - 0.1)))
    made.step(1)
    assert made.truth.velocity("a").linear[2] > 1e-4, "it is pushed back"


def test_a_raft_that_lies_aslant_is_turned_upright() -> None:
    made = world(plugin("Buoyancy", SEA) + body("<box><size>2 2 0.2</size></box>", mass=400, pose="0 0 0 0.1 0 0"))
    made.step(1)
    assert made.truth.velocity("a").angular[0] < -1e-4


@pytest.mark.parametrize("kind", ["box", "sphere", "cylinder", "mesh"])
def test_the_part_below_a_level_is_that_of_many_random_points(kind: str) -> None:
    half = np.array((0.4, 0.4, 0.6)) if kind != "sphere" else np.full(3, 0.5)
    mesh = None
    if kind == "mesh":
        corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
        mesh = TriangleMesh(np.array(corners, np.float32), np.array(faces, np.int32))
        half = np.ones(3)
    sizes = (float(2 * half[0]), float(2 * half[1]), float(2 * half[2]))
    shape = Solid(Geometry(kind, sizes, mesh=mesh))
    random = np.random.default_rng(1)
    points = random.uniform(-half, half, (40_000, 3))
    inside = {
        "box": np.ones(len(points), bool),
        "sphere": np.linalg.norm(points, axis=1) < 0.5,
        "cylinder": np.hypot(points[:, 0], points[:, 1]) < 0.4,
        "mesh": (points > 0).all(axis=1) & (points.sum(axis=1) < 1),
    }[kind]
    quaternion, position = quaternion_from_rpy(0.7, -0.4, 1.0), np.array((1.0, 2.0, 0.3))
    placed = points @ matrix(quaternion).T + position
    for level in (0.5, 0.7):
        below = inside & (placed[:, 2] < level)
        volume, centre = shape.below(level, position, matrix(quaternion))
        assert volume == pytest.approx(8.0 * np.prod(half) * below.mean(), rel=0.06)
        assert centre == pytest.approx(placed[below].mean(axis=0), abs=0.02)
    assert shape.below(9.0, position, matrix(quaternion))[1] == pytest.approx(
        position + rotate(quaternion, shape.centre)
    )
    assert shape.below(-9.0, position, matrix(quaternion))[0] == 0.0


def test_a_fluid_has_a_density() -> None:
    with pytest.raises(SdfError, match="<uniform_fluid_density> must be finite and not negative, got -1"):
        world(plugin("Buoyancy", "<uniform_fluid_density>-1</uniform_fluid_density>"))
    with pytest.raises(SdfError, match="belongs directly in the <world>"):
        world(body(plugins=plugin("Buoyancy")))
