"""Masses and inertias, as stated or computed from the collisions."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.pose import matrix
from gz_course.sim.gz.sim.sdf.description import Geometry, Inertial, TriangleMesh
from gz_course.sim.gz.sim.sdf.geometry import _cone
from gz_course.sim.gz.sim.sdf.inertia import solid
from gz_course.sim.gz.sim.sdf.reader import read_world


def inertial(link: str) -> tuple[Inertial, list[str]]:
    diagnostics = Diagnostics()
    text = f"<sdf version='1.11'><world name='w'><model name='m'><link name='l'>{link}</link></model></world></sdf>"
    return read_world(text, "f", diagnostics).models[0].links[0].inertial, diagnostics.warnings


def tensor(found: Inertial) -> np.ndarray:
    ixx, iyy, izz, ixy, ixz, iyz = found.moments
    turn = matrix(found.pose.quaternion)
    return turn @ np.array(((ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz))) @ turn.T


def box(name: str, size: str, pose: str = "", density: str = "") -> str:
    stated = f"<density>{density}</density>" if density else ""
    shape = f"<geometry><box><size>{size}</size></box></geometry>"
    return f"<collision name='{name}'>{f'<pose>{pose}</pose>' if pose else ''}{stated}{shape}</collision>"


def test_a_link_without_inertial_weighs_a_kilogram() -> None:
    assert inertial("")[0].moments == (1, 1, 1, 0, 0, 0)


def test_two_halves_are_the_whole() -> None:
    found, _ = inertial(
        "<inertial auto='true'><density>100</density></inertial>"
        + box("a", "1 2 3", "0.5 0 0 0 0 0")
        + box("b", "1 2 3", "-0.5 0 0 0 0 0")
    )
    whole, _ = inertial("<inertial auto='1'><density>100</density></inertial>" + box("a", "2 2 3"))
    assert found.mass == pytest.approx(1200) and found.pose.position == pytest.approx((0, 0, 0))
    assert np.allclose(tensor(found), tensor(whole)) and whole.moments[0] == pytest.approx(1200 * (4 + 9) / 12)


def test_the_density_of_the_collision_counts_before_that_of_the_link() -> None:
    found, _ = inertial(
        "<inertial auto='true'><density>10</density></inertial>"
        + box("a", "1 1 1", "1 0 0 0 0 0")
        + box("b", "1 1 1", "-1 0 0 0 0 0", "30")
    )
    assert found.mass == pytest.approx(40) and found.pose.position == pytest.approx((-0.5, 0, 0))
    water, _ = inertial("<inertial auto='true'/>" + box("a", "1 1 1"))
    assert water.mass == pytest.approx(1000)


def test_a_mass_beside_auto_scales_the_whole() -> None:
    found, _ = inertial("<inertial auto='true'><mass>6</mass></inertial>" + box("a", "1 1 1"))
    assert found.mass == 6 and found.moments[:3] == pytest.approx((1, 1, 1))


@given(st.tuples(*[st.floats(0.1, 2)] * 3), st.tuples(*[st.floats(-3, 3)] * 6))
def test_a_turned_shape_has_its_inertia_turned(size: tuple[float, ...], pose: tuple[float, ...]) -> None:
    text = box("a", " ".join(map(repr, size)), " ".join(map(repr, pose)), "1")
    found, _ = inertial(f"<inertial auto='true'/>{text}")
    plain, _ = inertial(f"<inertial auto='true'/>{box('a', ' '.join(map(repr, size)), '', '1')}")
    assert found.pose.position == pytest.approx(pose[:3])
    assert np.linalg.eigvalsh(tensor(found)) == pytest.approx(sorted(plain.moments[:3]), rel=1e-6)


def test_automatic_inertia_of_nothing_is_the_default_with_a_warning() -> None:
    plane = "<collision name='c'><geometry><plane/></geometry></collision>"
    found, warnings = inertial("<inertial auto='true'/>" + plane)
    assert found.mass == 1.0
    assert len(warnings) == 2 and "plane, which has no volume" in warnings[0] and "no collision" in warnings[1]


def surface(kind: str, size: tuple[float, float, float]) -> TriangleMesh:
    """Return a fine mesh of a round shape, as a stack of rings."""
    around = np.linspace(0, 2 * math.pi, 200, endpoint=False)
    up = np.linspace(-1, 1, 201)
    if kind == "cylinder":
        heights, radii = up * size[2] / 2, np.full_like(up, size[0] / 2)
    elif kind == "capsule":
        lift = np.sin(up * math.pi / 2)
        heights = lift * size[0] / 2 + np.sign(up) * size[2] / 2
        radii = np.cos(up * math.pi / 2) * size[0] / 2
    else:
        heights, radii = np.sin(up * math.pi / 2) * size[2] / 2, np.cos(up * math.pi / 2)
    rings = [
        np.stack((np.cos(around) * r, np.sin(around) * r, np.full(200, h)), 1)
        for h, r in zip(heights, radii, strict=True)
    ]
    vertices = np.concatenate([*rings, [(0, 0, heights[0])], [(0, 0, heights[-1])]])
    if kind == "ellipsoid":
        vertices[:, 0] *= size[0] / 2
        vertices[:, 1] *= size[1] / 2
    here = np.arange(200)
    after = (here + 1) % 200
    walls = [
        np.concatenate(
            (
                np.stack((k + here, k + after, k + 200 + after), 1),
                np.stack((k + here, k + 200 + after, k + 200 + here), 1),
            )
        )
        for k in range(0, 200 * 200, 200)
    ]
    low, high = len(vertices) - 2, len(vertices) - 1
    ends = [
        np.stack((np.full(200, low), after, here), 1),
        np.stack((np.full(200, high), 40000 + here, 40000 + after), 1),
    ]
    return TriangleMesh(vertices.astype(np.float32), np.concatenate([*walls, *ends]).astype(np.int32))


@pytest.mark.parametrize(
    ("kind", "size"), [("cylinder", (0.6, 0.6, 1.5)), ("capsule", (0.6, 0.6, 0.8)), ("ellipsoid", (0.4, 0.9, 1.3))]
)
def test_formulas_agree_with_meshes_of_the_same_shape(kind: str, size: tuple[float, float, float]) -> None:
    exact, meshed = solid(Geometry(kind, size)), solid(Geometry("mesh", size, mesh=surface(kind, size)))
    assert exact is not None and meshed is not None
    assert meshed[0] == pytest.approx(exact[0], rel=2e-3)
    assert meshed[1] == pytest.approx(exact[1], abs=1e-4)
    assert np.diag(meshed[2]) == pytest.approx(np.diag(exact[2]), rel=4e-3)


def test_a_cone_balances_a_quarter_up() -> None:
    size = (2.0, 2.0, 4.0)
    exact, meshed = solid(Geometry("cone", size)), solid(Geometry("mesh", size, mesh=_cone(size)))
    assert exact is not None and meshed is not None
    assert exact[1] == pytest.approx((0, 0, -1)) and meshed[1] == pytest.approx((0, 0, -1), abs=1e-6)
    assert exact[0] == pytest.approx(4 * math.pi / 3)
    assert np.diag(meshed[2]) == pytest.approx(np.diag(exact[2]), rel=0.03)


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        ("<mass>0</mass>", "<mass> must be greater than zero and below .* kg, got 0"),
        ("<mass>1e13</mass>", "below 1e.12 kg, got 1e.13"),
        ("<mass>-2</mass>", "got -2"),
        ("<mass>nan</mass>", "must not be NaN"),
        ("<mass>inf</mass>", "got inf"),
        ("<inertia><ixx>0</ixx></inertia>", "not positive"),
        ("<inertia><ixx>1</ixx><iyy>1</iyy><izz>3</izz></inertia>", "add up"),
        ("<inertia><ixy>inf</ixy></inertia>", "finite"),
    ],
)
def test_bodies_that_cannot_be_are_refused(inside: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=f"^f:1: .*{sentence}"):
        inertial(f"<inertial>{inside}</inertial>")


INERTIA = """<sdf version='1.10'><world name='w'><model name='m'><static>{static}</static><link name='l'><inertial>
<mass>1</mass><inertia><ixx>{0}</ixx><iyy>{1}</iyy><izz>{2}</izz><ixy>{3}</ixy></inertia></inertial></link></model></world></sdf>"""


@pytest.mark.parametrize(
    ("static", "moments", "refused"),
    [
        ("true", (1, 1, 3, 0), True),
        ("true", (-1, 1, 1, 0), True),
        ("true", (1, 1, 1, 2), True),
        ("true", (0, 0, 0, 0), False),
        ("false", (1, 1, 2.001, 0), True),
        ("false", (5.445e-05, 5.445e-05, 1.089e-04, 0), False),
        ("false", (1, 1, 1, 0), False),
    ],
)
def test_an_inertia_that_gazebo_refuses_is_named(static: str, moments: tuple[float, ...], refused: bool) -> None:
    diagnostics = Diagnostics()
    read_world(INERTIA.format(*moments, static=static), "w.sdf", diagnostics)
    assert not diagnostics.warnings
    assert ["w.sdf:2" in each and "A link named l has invalid" in each for each in diagnostics.differences] == [
        True
    ] * refused
