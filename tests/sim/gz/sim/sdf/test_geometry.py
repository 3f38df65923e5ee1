"""Shapes are built as specified; a shape that cannot be built is left out with a warning."""

from __future__ import annotations

import math
import random
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.sdf.convex import convex_pieces
from gz_course.sim.gz.sim.sdf.description import Collision, Geometry, Visual
from gz_course.sim.gz.sim.sdf.element import parse
from gz_course.sim.gz.sim.sdf.inertia import solid
from gz_course.sim.gz.sim.sdf.polyline import read_polyline
from gz_course.sim.gz.sim.sdf.reader import read_world
from gz_course.tests.sim.gz.sim.sdf.shapes_on_disk import write_heightmap, write_obj, write_stl

CUBE = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
_SIDES = "013 032 467 475 045 051 237 276 026 064 157 173"
FACES = np.array([[int(corner) for corner in side] for side in _SIDES.split()], dtype=np.int32)


def parts(folder: Path, geometry: str, static: bool = False) -> tuple[list[Collision], list[Visual], list[str]]:
    diagnostics = Diagnostics()
    inside = f"<geometry>{geometry}</geometry>"
    text = (
        f"<sdf version='1.11'>\n<world name='w'><model name='m'><static>{static}</static><link name='l'>\n"
        f"<collision name='c'>{inside}</collision>\n<visual name='v'>{inside}</visual></link></model></world></sdf>"
    )
    link = read_world(text, str(folder / "w.sdf"), diagnostics).models[0].links[0]
    return link.collisions, link.visuals, diagnostics.warnings


def test_a_mesh_is_read_scaled_and_shared(tmp_path: Path) -> None:
    write_obj(tmp_path / "ell.obj")
    mesh = "<mesh><uri>ell.obj</uri><scale>0.5 2 3</scale></mesh>"
    collisions, visuals, _ = parts(tmp_path, mesh)
    seen = visuals[0].geometry
    assert seen.kind == "mesh" and seen.size == pytest.approx((1, 4, 3))
    assert seen.mesh is not None and seen.mesh.vertices.dtype == np.float32
    volume, _, _ = solid(seen)  # type: ignore[misc]
    assert volume == pytest.approx(3 * 0.5 * 2 * 3)
    again = parts(tmp_path, mesh)[1][0].geometry.mesh
    assert again is seen.mesh
    assert collisions[0].geometry.mesh is not None and len(collisions[0].geometry.mesh.pieces) == 1


def test_a_mirrored_mesh_keeps_its_outside_outside(tmp_path: Path) -> None:
    write_stl(tmp_path / "t.stl")
    _, visuals, _ = parts(tmp_path, "<mesh><uri>t.stl</uri><scale>-1 1 1</scale></mesh>")
    mesh = visuals[0].geometry.mesh
    assert mesh is not None
    a, b, c = (mesh.vertices[mesh.triangles[:, k]].astype(float) for k in range(3))
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(1 / 6)


@pytest.mark.parametrize(
    ("geometry", "sentence"),
    [
        ("<mesh><uri>nothing.stl</uri></mesh>", "'nothing.stl' was not found"),
        ("<mesh/>", "<mesh> has no <uri>"),
        ("<mesh><uri>broken.stl</uri></mesh>", "broken.stl"),
        ("<mesh><uri>flat.stl</uri><scale>1e-9 1 1</scale></mesh>", "has no surface"),
        ("<heightmap><uri>nothing.png</uri></heightmap>", "was not found"),
        ("<heightmap><uri>broken.png</uri></heightmap>", "cannot move"),
        ("<image><uri>x.png</uri></image>", "<image> geometry is not simulated"),
        ("<polyline><point>0 0</point><point>2 2</point><point>2 0</point><point>0 2.1</point></polyline>", "crosses"),
    ],
)
def test_shapes_that_cannot_be_built_are_left_out_with_a_sentence(tmp_path: Path, geometry: str, sentence: str) -> None:
    (tmp_path / "broken.stl").write_bytes(b"solid x\nfacet garbage")
    (tmp_path / "flat.stl").write_bytes(b"")
    write_stl(tmp_path / "flat.stl", ((0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)))
    if "nothing.png" in geometry:
        collisions, visuals, warnings = parts(tmp_path, geometry, static=True)
    else:
        collisions, visuals, warnings = parts(tmp_path, geometry.replace("1e-9 1 1", "1 1 1"))
    assert collisions == [] and visuals == []
    assert len(warnings) == 2 and sentence in warnings[0]
    assert warnings[0].startswith(f"{tmp_path / 'w.sdf'}:3: ") and "is left out" in warnings[0]


@pytest.mark.parametrize(
    "geometry",
    [
        "<box><size>1 0 1</size></box>",
        "<sphere><radius>-1</radius></sphere>",
        "<sphere><radius>1e300</radius></sphere>",
        "<cone><radius>1</radius><length>0</length></cone>",
        "<ellipsoid><radii>1 1 inf</radii></ellipsoid>",
        "<plane><normal>0 0 0</normal></plane>",
        "<mesh><uri>x.stl</uri><scale>1 0 1</scale></mesh>",
        "<polyline><point>0 0</point><point>1 0</point></polyline>",
        "<polyline><point>0 0</point><point>1 0</point><point>1 1</point><height>-1</height></polyline>",
        "<heightmap><uri>h.png</uri><size>1 1 0</size></heightmap>",
    ],
)
def test_impossible_sizes_are_refused_at_their_line(tmp_path: Path, geometry: str) -> None:
    with pytest.raises(SdfError, match=r"w\.sdf:3: "):
        parts(tmp_path, geometry, static=True)


def test_a_heightmap_has_its_first_row_at_plus_y(tmp_path: Path) -> None:
    pixels = np.zeros((3, 4), dtype=np.uint8)
    pixels[0, 3] = 200
    pixels[2, 0] = 100
    write_heightmap(tmp_path / "h.png", pixels)
    collisions, visuals, warnings = parts(
        tmp_path, "<heightmap><uri>h.png</uri><size>30 20 5</size><pos>1 2 3</pos></heightmap>", static=True
    )
    heights = collisions[0].geometry.heights
    assert warnings == [] and heights is not None
    assert heights[2, 3] == pytest.approx(5.0) and heights[0, 0] == pytest.approx(2.5) and heights.sum() == 7.5
    mesh = visuals[0].geometry.mesh
    assert mesh is not None and visuals[0].pose.position == pytest.approx((1, 2, 3))
    highest = mesh.vertices[np.argmax(mesh.vertices[:, 2])]
    assert highest == pytest.approx((15, 10, 5))
    assert len(mesh.triangles) == 2 * 2 * 3


def area(points: list[tuple[float, float]]) -> float:
    return 0.5 * sum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in zip(points, points[1:] + points[:1], strict=True))


def polyline(*rings: list[tuple[float, float]], height: float = 2.0) -> Geometry | None:
    text = "".join(
        "<polyline>" + "".join(f"<point>{x!r} {y!r}</point>" for x, y in ring) + f"<height>{height}</height></polyline>"
        for ring in rings
    )
    return read_polyline(parse(f"<g>{text}</g>").children)


def footprint(geometry: Geometry) -> float:
    assert geometry.mesh is not None
    return sum(area([(x, y) for x, y, z in piece[: len(piece) // 2].tolist()]) for piece in geometry.mesh.pieces)


@given(st.lists(st.floats(0.3, 3.0), min_size=3, max_size=14), st.booleans())
def test_the_pieces_of_any_star_fill_it_and_are_convex(radii: list[float], clockwise: bool) -> None:
    count = len(radii)
    ring = [(r * math.cos(2 * math.pi * k / count), r * math.sin(2 * math.pi * k / count)) for k, r in enumerate(radii)]
    made = polyline(ring[::-1] if clockwise else ring)
    assert made is not None and made.mesh is not None
    assert footprint(made) == pytest.approx(area(ring), rel=1e-9)
    volume, _, _ = solid(made)  # type: ignore[misc]
    assert volume == pytest.approx(2.0 * area(ring), rel=1e-5)
    for piece in made.mesh.pieces:
        corners = piece[: len(piece) // 2, :2]
        one, two = np.roll(corners, -1, axis=0) - corners, np.roll(corners, -2, axis=0) - np.roll(corners, -1, axis=0)
        assert np.all(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0] >= -1e-9)


def test_outlines_inside_outlines_are_holes_and_islands() -> None:
    def square(side: float, at: float) -> list[tuple[float, float]]:
        return [(at, at), (at + side, at), (at + side, at + side), (at, at + side)]

    made = polyline(square(10, 0), square(8, 1), square(6, 2), square(2, 3))
    assert made is not None and footprint(made) == pytest.approx(100 - 64 + 36 - 4)
    assert solid(made)[0] == pytest.approx(2 * 68, rel=1e-5)  # type: ignore[index]


@pytest.mark.parametrize("seed", range(20))
def test_holes_that_are_apart_are_cut_out(seed: int) -> None:
    chance = random.Random(seed)
    holes = [[chance.uniform(0.3, 1.5) for _ in range(chance.randint(3, 8))] for _ in range(9)]

    def star(radii: list[float], x: float, y: float) -> list[tuple[float, float]]:
        angles = [2 * math.pi * k / len(radii) for k in range(len(radii))]
        return [(x + r * math.cos(a), y + r * math.sin(a)) for r, a in zip(radii, angles, strict=True)]

    rings = [star(radii, 4.0 * (k % 3), 4.0 * (k // 3)) for k, radii in enumerate(holes)]
    made = polyline([(-3, -3), (11, -3), (11, 11), (-3, 11)], *rings)
    assert made is not None and footprint(made) == pytest.approx(14**2 - sum(map(area, rings)), rel=1e-9)


def test_convex_parts_of_a_mesh_touch_one_by_one() -> None:
    both = np.concatenate([CUBE, CUBE + np.array((3, 0, 0))])
    pieces, fuller = convex_pieces(both, np.concatenate([FACES, FACES + 8]), moving=True)
    assert len(pieces) == 2 and not fuller
    assert [tuple(piece.max(axis=0)) for piece in pieces] == [(1, 1, 1), (4, 1, 1)]


def test_a_concave_body_that_moves_is_its_hull_and_a_room_stays_hollow(tmp_path: Path) -> None:
    write_obj(tmp_path / "ell.obj")
    collisions, _, warnings = parts(tmp_path, "<mesh><uri>ell.obj</uri></mesh>")
    assert len(collisions[0].geometry.mesh.pieces) == 1  # type: ignore[union-attr]
    assert len(warnings) == 1 and "convex hull of ell.obj, which is 17% larger than the mesh" in warnings[0]
    collisions, _, warnings = parts(tmp_path, "<mesh><uri>ell.obj</uri></mesh>", static=True)
    assert len(collisions[0].geometry.mesh.pieces) == 20 and warnings == []  # type: ignore[union-attr]
    pieces, fuller = convex_pieces(CUBE, FACES[:, ::-1], moving=False)
    assert len(pieces) == 12 and not fuller
    for piece in pieces:  # the wedges are outside of the room
        assert np.any((piece < -1e-4) | (piece > 1 + 1e-4))
    assert len(convex_pieces(CUBE, FACES[:, ::-1], moving=True)[0]) == 1


NOTCHED = ((0, 0), (2, 0), (2, 2), (1.1, 2), (1.1, 1.9), (0.9, 1.9), (0.9, 2), (0, 2))
"""A square of area 4 m^2 with a notch of 0.02 m^2."""


def test_a_hull_that_hardly_differs_is_not_worth_a_sentence(tmp_path: Path) -> None:
    write_obj(tmp_path / "notched.obj", NOTCHED)
    collisions, _, warnings = parts(tmp_path, "<mesh><uri>notched.obj</uri></mesh>")
    assert len(collisions[0].geometry.mesh.pieces) == 1 and warnings == []  # type: ignore[union-attr]


def test_by_how_much_a_hull_is_larger() -> None:
    deep = CUBE.copy()
    deep[deep[:, 2] == 1, :2] = 0.5 + 3.0 * (deep[deep[:, 2] == 1, :2] - 0.5)
    assert convex_pieces(CUBE, FACES, moving=True)[1] == convex_pieces(deep, FACES, moving=True)[1] == 0.0
    # A cube without a pyramid of a quarter of its volume at the top.
    middle = np.concatenate([CUBE, [(0.5, 0.5, 0.25)]])
    top = [face for face in FACES.tolist() if (CUBE[face][:, 2] == 1).all()]
    rest = [face for face in FACES.tolist() if face not in top]
    ring = sorted({index for face in top for index in face}, key=lambda i: math.atan2(*(CUBE[i, 1::-1] - 0.5)))
    lid = [(ring[k], ring[(k + 1) % 4], 8) for k in range(4)]
    dented = np.array([*rest, *lid], dtype=np.int32)
    assert convex_pieces(middle, dented, moving=True)[1] == pytest.approx(1 / 0.75 - 1)
    assert convex_pieces(middle, dented[:-1], moving=True)[1] == math.inf


def test_a_flat_part_gets_a_thickness_and_a_line_is_no_part() -> None:
    corners = np.array([(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)], dtype=float)
    pieces, _ = convex_pieces(corners, np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int32), moving=True)
    assert len(pieces) == 1 and np.ptp(pieces[0], axis=0) == pytest.approx((2, 2, 0.001))
    line = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0)], dtype=float)
    assert convex_pieces(line, np.array([(0, 1, 2)], dtype=np.int32), moving=True) == ((), False)


@given(st.lists(st.tuples(*[st.floats(-5, 5)] * 3), min_size=0, max_size=12), st.booleans(), st.randoms())
def test_any_triangles_have_pieces_of_finite_points(points: list[tuple[float, ...]], moving: bool, random) -> None:
    count = len(points)
    triangles = [[random.randrange(count) for _ in range(3)] for _ in range(6)] if count else []
    pieces, _ = convex_pieces(
        np.array(points, dtype=float).reshape(-1, 3), np.array(triangles, dtype=np.int32).reshape(-1, 3), moving=moving
    )
    assert all(len(piece) >= 3 and np.all(np.isfinite(piece)) for piece in pieces)
