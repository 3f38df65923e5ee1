"""Mesh files: STL, OBJ and, if its reader is installed, COLLADA; messages about damaged files."""

from __future__ import annotations

import importlib.util
import json
import os
import struct
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import ResourceError
from gz_course.sim.gz.sim.sdf.meshes import Mesh, read_mesh
from gz_course.sim.gz.sim.sdf.resources import find_file

CORNERS = np.array([(0, 0, 0), (2, 0, 0), (0, 1, 0), (0, 0, 3)], float)
TETRAHEDRON = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
SIX_TIMES_VOLUME = 2.0 * 1.0 * 3.0

OBJ = """# a tetrahedron of two objects
mtllib none.mtl
o lower
v 0 0 0
v 2 0 0 1.0
v 0 1 0
vn 0 0 1
f 1//1 3//1 2//1
o upper
g sides all
v 0 0 3
f 1 2 -1
f -4/1 4/2 3/3
f 2 3 \\
4
"""


def volume6(mesh: Mesh) -> float:
    """Return six times the signed volume, positive if all normals point outwards."""
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)))


def binary_stl(triangles: np.ndarray, header: bytes = b"made for a test") -> bytes:
    facets = b"".join(struct.pack("<12fH", 0, 0, 1, *corners.reshape(-1), 0) for corners in triangles)
    return header.ljust(80, b"\0") + struct.pack("<I", len(triangles)) + facets


def ascii_stl(triangles: np.ndarray, name: str = "part") -> str:
    text = f"solid {name}\n"
    for corners in triangles:
        loop = "".join(f"   vertex {x!r} {y!r} {z!r}\n" for x, y, z in corners.tolist())
        text += f" facet normal 0 0 1\n  outer loop\n{loop}  endloop\n endfacet\n"
    return text + f"endsolid {name}\n"


def test_a_binary_stl(tmp_path: Path) -> None:
    (tmp_path / "a.STL").write_bytes(binary_stl(CORNERS[TETRAHEDRON]))
    mesh = read_mesh(tmp_path / "a.STL")
    assert (mesh.vertices.shape, mesh.vertices.dtype, mesh.triangles.dtype) == ((4, 3), np.float64, np.int32)
    assert volume6(mesh) == pytest.approx(SIX_TIMES_VOLUME)
    assert not mesh.vertices.flags.writeable


def test_a_binary_stl_whose_header_says_solid_and_one_with_bytes_behind_it(tmp_path: Path) -> None:
    path = tmp_path / "a.stl"
    for data in (binary_stl(CORNERS[TETRAHEDRON], b"solid of steel"), binary_stl(CORNERS[TETRAHEDRON]) + b"more"):
        path.write_bytes(data)
        assert volume6(read_mesh(path)) == pytest.approx(SIX_TIMES_VOLUME)


def test_an_ascii_stl_and_its_solids(tmp_path: Path) -> None:
    path = tmp_path / "a.stl"
    path.write_text(ascii_stl(CORNERS[TETRAHEDRON[:1]], "floor of it") + ascii_stl(CORNERS[TETRAHEDRON[1:]], "roof"))
    assert volume6(read_mesh(path)) == pytest.approx(SIX_TIMES_VOLUME)
    assert len(read_mesh(path, submesh="floor of it").triangles) == 1


def test_an_obj_its_objects_and_groups(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.write_text(OBJ)
    mesh = read_mesh(path)
    assert (len(mesh.vertices), len(mesh.triangles)) == (4, 4)
    assert volume6(mesh) == pytest.approx(SIX_TIMES_VOLUME)
    for name in ("upper", "sides", "all"):
        assert len(read_mesh(path, submesh=name).triangles) == 3
    lower = read_mesh(path, submesh="lower")
    assert sorted(map(tuple, lower.vertices.tolist())) == [(0, 0, 0), (0, 1, 0), (2, 0, 0)]


def test_center_puts_the_middle_of_the_box_at_the_origin(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text(OBJ)
    mesh = read_mesh(tmp_path / "a.obj", submesh="upper", center=True)
    assert (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)).tolist() == [0, 0, 0]
    assert np.ptp(mesh.vertices, axis=0).tolist() == [2, 1, 3]


def test_faces_with_many_corners_become_fans(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text("".join(f"v {i} {i * i} 0\n" for i in range(6)) + "f 1 2 3 4 5 6\n")
    assert len(read_mesh(tmp_path / "a.obj").triangles) == 4


@pytest.mark.parametrize(
    ("name", "data", "sentence"),
    [
        ("a.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 3\n", r"a\.obj:3: a face names vertex 3, but 2 vertices"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 0\n", r":4: a face names vertex 0"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 -9\n", r":4: a face names vertex -9"),
        ("a.obj", b"v 0 0\n", r":1: a vertex needs 3 finite numbers, got '0 0'"),
        ("a.obj", b"v 0 0 nan\n", r":1: a vertex needs 3 finite numbers"),
        ("a.obj", b"v 0 0 0\nf 1 1\n", r":2: a face needs at least three corners"),
        ("a.obj", b"v 0 0 0\nf 1 a 1\n", r":2: 'a' is no corner of a face"),
        ("a.obj", b"v 0 0 1e300\nv 1 0 0\nv 1 1 0\nf 1 2 3", "not finite or is farther"),
        ("a.obj", b"", "has no triangle"),
        ("a.obj", b"v 0 0 0\nf 1 1 1\n", "has no triangle"),
        ("a.obj", b"v 0 0 0 \\", "cut off"),
        ("a.stl", b"", "too few for a header"),
        ("a.stl", binary_stl(CORNERS[TETRAHEDRON])[:-7], "announces 4 triangles and holds 3"),
        ("a.stl", b"solid x\n facet normal 0 0 1\n  outer loop\n   vertex 0 0\n", r":4: a vertex needs 3"),
        ("a.stl", b"solid x\nvertex 0 0 0\n", r":2: 'vertex' stands outside of a loop"),
        ("a.stl", b"solid x\nouter loop\nendloop\n", r":3: a loop needs three vertices, got 0"),
        ("a.stl", b"solid x\nfacets\n", r":2: 'facets' is no word"),
        ("a.stl", ascii_stl(CORNERS[TETRAHEDRON])[:-14].encode(), "cut off: its last line is not 'endsolid'"),
        ("a.stl", b"solid x\nendsolid x\n", "has no triangle"),
        ("a.ply", b"", r"kind \.ply are not read here; use \.obj or \.stl"),
        ("a.txt", b"", r"ending '\.txt' is not that of a mesh"),
    ],
)
def test_damaged_files_are_refused_with_a_sentence(tmp_path: Path, name: str, data: bytes, sentence: str) -> None:
    (tmp_path / name).write_bytes(data)
    with pytest.raises(ResourceError, match=sentence) as caught:
        read_mesh(tmp_path / name)
    assert str(caught.value).startswith(str(tmp_path / name)) and "\n" not in str(caught.value)


def test_a_missing_file_names_the_nearest_one_and_a_missing_submesh_too(tmp_path: Path) -> None:
    (tmp_path / "wheel.obj").write_text(OBJ)
    with pytest.raises(ResourceError, match=r"no such mesh file; did you mean 'wheel\.obj'"):
        read_mesh(tmp_path / "whel.obj")
    with pytest.raises(ResourceError, match=r"no submesh 'uper'; did you mean 'upper'"):
        read_mesh(tmp_path / "wheel.obj", submesh="uper")
    with pytest.raises(ResourceError, match="no such mesh file"):
        read_mesh(tmp_path / "nowhere" / "wheel.obj")


def test_a_huge_file_is_refused_before_it_is_read(tmp_path: Path) -> None:
    with (tmp_path / "a.stl").open("wb") as file:
        file.truncate(300 * 2**20)
    with pytest.raises(ResourceError, match="300 MiB"):
        read_mesh(tmp_path / "a.stl")


FINITE = st.floats(-1e6, 1e6, width=32)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=60)
@given(st.lists(st.tuples(*[st.tuples(FINITE, FINITE, FINITE)] * 3), min_size=1, max_size=8))
def test_the_three_writings_of_a_mesh_are_read_alike(tmp_path: Path, corners: list) -> None:
    triangles = np.array(corners, float)
    (tmp_path / "b.stl").write_bytes(binary_stl(triangles))
    (tmp_path / "a.stl").write_text(ascii_stl(triangles))
    flat = triangles.reshape(-1, 3).tolist()
    faces = "".join(f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}\n" for i in range(len(triangles)))
    (tmp_path / "c.obj").write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in flat) + faces)
    read = []
    for name in ("b.stl", "a.stl", "c.obj"):
        try:
            mesh = read_mesh(tmp_path / name)
            read.append(mesh.vertices[mesh.triangles].tolist())
        except ResourceError as error:
            assert "no triangle" in str(error)
            read.append([])
    wanted = [t.tolist() for t in triangles if len({tuple(corner + 0.0) for corner in t}) == 3]
    assert read == [wanted] * 3


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=150)
@given(st.sampled_from(["stl", "obj", "ascii"]), st.integers(0, 400), st.integers(0, 30), st.binary(max_size=6))
@example("stl", 168, 0, b"\x81\x7f")
def test_any_damage_is_read_or_refused(tmp_path: Path, kind: str, start: int, length: int, put: bytes) -> None:
    whole = {
        "stl": binary_stl(CORNERS[TETRAHEDRON]),
        "obj": OBJ.encode(),
        "ascii": ascii_stl(CORNERS[TETRAHEDRON]).encode(),
    }[kind]
    path = tmp_path / ("a.obj" if kind == "obj" else "a.stl")
    path.write_bytes(whole[:start] + put + whole[start + length :])
    try:
        mesh = read_mesh(path)
        assert np.isfinite(mesh.vertices).all()
        assert 0 <= mesh.triangles.min() <= mesh.triangles.max() < len(mesh.vertices)
    except ResourceError as error:
        assert "\n" not in str(error)


DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset><unit name="centimeter" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
 <library_geometries><geometry id="g" name="tetra"><mesh>
  <source id="p"><float_array id="pa" count="12">0 0 0 2 0 0 0 1 0 0 0 3</float_array><technique_common>
   <accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
   <param name="Z" type="float"/></accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <triangles count="3"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2</p></triangles>
  <polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>3</vcount><p>1 2 3</p></polylist>
 </mesh></geometry></library_geometries>
 <library_visual_scenes><visual_scene id="s">
  <node name="outer"><translate>100 0 0</translate>
   <node><scale>1 1 -1</scale><instance_geometry url="#g"/></node>
   <node name="second"><translate>0 0 700</translate><instance_geometry url="#g"/></node>
  </node></visual_scene></library_visual_scenes>
 <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>"""


def test_collada_without_its_reader_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a.dae").write_text(DAE)
    monkeypatch.setitem(sys.modules, "collada", None)
    monkeypatch.delitem(sys.modules, "gz_course.sim.gz.sim.sdf.collada_mesh", raising=False)
    monkeypatch.delattr("gz_course.sim.gz.sim.sdf.collada_mesh", raising=False)
    with pytest.raises(ResourceError, match=r"pip install 'gz-ros2-course\[collada\]'"):
        read_mesh(tmp_path / "a.dae")


needs_collada = pytest.mark.skipif(importlib.util.find_spec("collada") is None, reason="the extra collada is missing")


@needs_collada
def test_collada_nodes_unit_and_mirrors(tmp_path: Path) -> None:
    path = tmp_path / "a.dae"
    path.write_text(DAE)
    whole = read_mesh(path)
    assert whole.vertices.min(axis=0) == pytest.approx((1.0, 0.0, -0.03))
    assert whole.vertices.max(axis=0) == pytest.approx((1.02, 0.01, 7.03))
    assert volume6(read_mesh(path, submesh="outer", center=True)) == pytest.approx(SIX_TIMES_VOLUME * 1e-6, rel=1e-4)
    assert read_mesh(path, submesh="second").vertices.min(axis=0) == pytest.approx((1.0, 0.0, 7.0))
    assert len(read_mesh(path, submesh="tetra").triangles) == 8


IMAGE = """<library_images><image id="i"/></library_images><library_effects><effect id="e"><profile_COMMON>
<newparam sid="f"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="s"><sampler2D><source>f</source></sampler2D></newparam>
<technique sid="t"><lambert><diffuse><texture texture="s" texcoord="u"/></diffuse></lambert></technique>
</profile_COMMON></effect></library_effects>"""


@needs_collada
@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('name="second"', 'name="$<tetra>"'),
        (" <library_geometries>", f"{IMAGE}<library_geometries>"),
    ],
)
def test_what_exporters_get_wrong_costs_no_shape(tmp_path: Path, old: str, new: str) -> None:
    path = tmp_path / "a.dae"
    path.write_text(DAE.replace(old, new))
    assert len(read_mesh(path).triangles) == 8


def test_a_pointer_of_git_lfs_is_named(tmp_path: Path) -> None:
    path = tmp_path / "part.stl"
    path.write_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 12345\n")
    with pytest.raises(
        ResourceError, match="this is the pointer of Git LFS to a file that was not fetched; `git lfs p"
    ):
        read_mesh(path)


@needs_collada
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=60)
@given(st.integers(0, len(DAE) - 1), st.integers(0, 30), st.sampled_from(["", "9", "<", "nan ", "#g"]))
def test_damaged_collada_is_read_or_refused(tmp_path: Path, start: int, length: int, put: str) -> None:
    (tmp_path / "a.dae").write_text(DAE[:start] + put + DAE[start + length :])
    try:
        read_mesh(tmp_path / "a.dae")
    except ResourceError as error:
        assert "\n" not in str(error)


@pytest.mark.parametrize(("make", "kind"), [(os.mkfifo, "a FIFO"), (Path.mkdir, "a folder"), (None, "a device")])
def test_what_is_no_file_is_named_and_never_opened(make, kind, tmp_path):
    path = tmp_path / "mesh.stl"
    path.symlink_to("/dev/zero") if make is None else make(path)
    with pytest.raises(ResourceError, match=f"a mesh is a file, but this is {kind}"):
        read_mesh(path)
    with pytest.raises(ResourceError, match=f"'mesh.stl' is no file but {kind}"):
        find_file("mesh.stl", tmp_path)


def test_nodes_that_double_forty_times_are_too_many(tmp_path):
    nodes = [{"children": [number + 1, number + 1]} for number in range(40)] + [{}]
    path = tmp_path / "many.gltf"
    path.write_text(json.dumps({"asset": {"version": "2.0"}, "nodes": nodes, "scenes": [{"nodes": [0]}], "scene": 0}))
    with pytest.raises(ResourceError, match="shows its nodes more than"):
        read_mesh(path)
