"""Textures and the looks of mesh files: read, limited, handed over, and built into MuJoCo's model."""

from __future__ import annotations

import base64
import io
import json
import struct
import zlib
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PIL import Image

from gz_course.sim.gz.sim.errors import Diagnostics, ResourceError
from gz_course.sim.gz.sim.sdf import packing
from gz_course.sim.gz.sim.sdf.assets import Assets, address, mesh_bytes
from gz_course.sim.gz.sim.sdf.meshes import read_mesh
from gz_course.sim.gz.sim.sdf.packing import pack
from gz_course.sim.gz.sim.sdf.reader import read_world
from gz_course.sim.gz.sim.sdf.textures import LARGEST, read_texture
from gz_course.sim.gz.sim.world import World

QUARTERS = np.array([[(255, 0, 0), (0, 255, 0)], [(0, 0, 255), (255, 255, 0)]], np.uint8).repeat(8, 0).repeat(8, 1)
"""Red and green above, blue and yellow below."""
OBJ = """mtllib a.mtl
v 0 0 0
v 1 0 0
v 1 0 1
v 0 0 1
v 0 1 0
v 1 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl painted
f 1/1 2/2 3/3 4/4
usemtl plain
f 1 5 6 2
"""
MTL = "newmtl painted\nKd 0 0 0\nmap_Kd -s 1 1 1 a.png\nnewmtl plain\nKd 0.1 0.2 0.3\nd 0.5\n"


def write(folder: Path) -> None:
    Image.fromarray(QUARTERS).save(folder / "a.png")
    (folder / "a.obj").write_text(OBJ)
    (folder / "a.mtl").write_text(MTL)


def gltf(embedded: bool) -> dict:
    """A square with a texture in the plane y = 0, as a JSON document with everything in data URIs or in one chunk."""
    png = io.BytesIO()
    Image.fromarray(QUARTERS).save(png, "PNG")
    parts = [
        struct.pack("<12f", 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1),
        struct.pack("<8f", 0, 1, 1, 1, 1, 0, 0, 0),
        struct.pack("<6H", 0, 1, 2, 0, 2, 3),
        png.getvalue(),
    ]
    starts = [sum(map(len, parts[:i])) for i in range(4)]
    data = b"".join(parts)
    document = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1], "translation": [0, 0, 2]}, {"mesh": 0, "name": "sign", "scale": [2, 2, 2]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 0.5, 1, 1]}}],
        "textures": [{"source": 0}],
        "images": [{"bufferView": 3, "mimeType": "image/png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": start, "byteLength": len(part)}
            for start, part in zip(starts, parts, strict=True)
        ],
        "buffers": [{"byteLength": len(data)}],
    }
    if not embedded:
        document["buffers"][0]["uri"] = "data:;base64," + base64.b64encode(data).decode()  # type: ignore[index]
        return document
    return document | {"binary": data}


def glb() -> bytes:
    document = gltf(embedded=True)
    binary = document.pop("binary")
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def test_an_obj_has_the_colours_and_textures_of_its_mtl(tmp_path: Path) -> None:
    write(tmp_path)
    mesh = read_mesh(tmp_path / "a.obj")
    assert mesh.look is not None and mesh.uv is not None and mesh.notes == ()
    assert [look.rgba for look in mesh.looks] == [(1.0, 1.0, 1.0, 1.0), (0.1, 0.2, 0.3, 0.5)]
    assert mesh.looks[0].texture is not None and (mesh.looks[0].texture == QUARTERS).all()
    assert mesh.look.tolist() == [0, 0, 1, 1]
    # The first corner of the file is the lower left of the texture.
    assert mesh.uv[0].tolist() == [[0, 1], [1, 1], [1, 0]]
    assert (read_mesh(tmp_path / "a.obj", center=True).triangles == mesh.triangles).all()
    (tmp_path / "a.mtl").unlink()
    bare = read_mesh(tmp_path / "a.obj")
    assert bare.looks == () and "a.mtl: the material file cannot be read" in bare.notes[0]
    assert (bare.vertices == mesh.vertices).all() and (bare.triangles == mesh.triangles).all()


@pytest.mark.parametrize("name", ["a.gltf", "a.glb"])
def test_gltf_with_its_nodes_and_embedded_texture(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(glb() if name == "a.glb" else json.dumps(gltf(embedded=False)).encode())
    mesh = read_mesh(tmp_path / name, submesh="sign")
    assert mesh.vertices.min(axis=0).tolist() == [0, 0, 2] and mesh.vertices.max(axis=0).tolist() == [2, 0, 4]
    (look,) = mesh.looks
    assert look.rgba == (1.0, 0.5, 1.0, 1.0) and look.texture is not None and (look.texture == QUARTERS).all()
    corner = mesh.vertices[mesh.triangles[0, 0]].tolist()
    assert mesh.uv is not None and mesh.uv[0, 0].tolist() == [corner[0] / 2, 1 - (corner[2] - 2) / 2]


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.integers(0, 1500), st.integers(1, 6), st.binary(max_size=8))
def test_damaged_gltf_is_read_or_refused(tmp_path: Path, start: int, length: int, put: bytes) -> None:
    whole = glb()
    (tmp_path / "a.glb").write_bytes(whole[:start] + put + whole[start + length :])
    try:
        mesh = read_mesh(tmp_path / "a.glb")
    except ResourceError as error:
        assert str(tmp_path / "a.glb") in str(error)
    else:
        assert mesh.triangles.max() < len(mesh.vertices)


def test_gltf_in_a_circle_ends(tmp_path: Path) -> None:
    document = gltf(embedded=False)
    document["nodes"][1]["children"] = [0, 0]
    (tmp_path / "a.gltf").write_text(json.dumps(document))
    with pytest.raises(ResourceError, match="nested too deeply or in a circle"):
        read_mesh(tmp_path / "a.gltf")


def test_large_and_damaged_textures(tmp_path: Path) -> None:
    Image.new("RGB", (4 * LARGEST, LARGEST), (10, 20, 30)).save(tmp_path / "long.jpg")
    assert read_texture(tmp_path / "long.jpg").shape == (LARGEST // 4, LARGEST, 3)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    # A small file that says it has 10^10 pixels.
    header = struct.pack(">IIBBBBB", 100_000, 100_000, 8, 2, 0, 0, 0)
    bomb = (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(1000))) + chunk(b"IEND", b"")
    )
    (tmp_path / "bomb.png").write_bytes(bomb)
    with pytest.raises(ResourceError, match=r"100000 x 100000 pixels|decompression bomb"):
        read_texture(tmp_path / "bomb.png")
    (tmp_path / "a.png").write_bytes(b"GIF89a")
    with pytest.raises(ResourceError, match="not a readable PNG or JPEG"):
        read_texture(tmp_path / "a.png")
    with pytest.raises(ResourceError, match=r"b\.png cannot be read .*a\.png"):
        read_texture(tmp_path / "b.png")


WORLD = (
    "<sdf version='1.10'><world name='w'><model name='m'><static>1</static><link name='l'>"
    "<visual name='box'><geometry><box><size>1 1 1</size></box></geometry>"
    "<material><pbr><metal><albedo_map>a.png</albedo_map></metal></pbr></material></visual>"
    "<visual name='mesh'><geometry><mesh><uri>a.obj</uri></mesh></geometry></visual></link></model></world></sdf>"
)


def test_a_world_with_textures_is_handed_over_without_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path)
    packed = pack(WORLD, str(tmp_path / "w.sdf"))
    assets = Assets()
    for name, data in packed.assets.items():
        assets.add(name, data)
    world = read_world(assets.text(packed.description), "w.sdf", Diagnostics(quiet=True), assets)
    box, mesh = world.models[0].links[0].visuals
    assert box.texture is not None and (box.texture == QUARTERS).all() and box.rgba == (1, 1, 1, 1)
    assert mesh.geometry.mesh is not None and [look.rgba[0] for look in mesh.geometry.mesh.looks] == [
        1.0,
        pytest.approx(0.1),
    ]
    monkeypatch.setattr(packing, "MOST_TEXTURE_BYTES", 10)
    poor = pack(WORLD, str(tmp_path / "w.sdf"))
    assert sum(map(len, poor.assets.values())) < sum(map(len, packed.assets.values())) - 2 * QUARTERS.nbytes + 100


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.integers(0, 1400), st.binary(min_size=1, max_size=8), st.booleans())
def test_a_damaged_mesh_is_refused_or_whole(tmp_path: Path, at: int, put: bytes, longer: bool) -> None:
    write(tmp_path)
    good = mesh_bytes(read_mesh(tmp_path / "a.obj"))
    data = good[:at] + put + good[at + (0 if longer else len(put)) :]
    assets = Assets()
    name = address(data, "mesh")
    assets.add(name, data)
    try:
        mesh = assets.read_mesh(Path(name), "", False)
    except ResourceError:
        return
    assert mesh.triangles.max() < len(mesh.vertices) and (mesh.uv is None or len(mesh.uv) == len(mesh.triangles))
    assert mesh.look is None or mesh.look.max() < len(mesh.looks)


def test_mujocos_model_carries_textures_and_the_looks_of_a_mesh(tmp_path: Path) -> None:
    write(tmp_path)
    (tmp_path / "w.sdf").write_text(WORLD)
    model = World.load(str(tmp_path / "w.sdf")).model
    names = ["m::l::box#visual", "m::l::mesh#visual", "m::l::mesh#visual#1"]
    geoms = [model.geom(name) for name in names]
    assert [geom.group[0] for geom in geoms] == [1, 1, 1]
    assert geoms[2].rgba == pytest.approx((0.1, 0.2, 0.3, 0.5))
    role = mujoco.mjtTextureRole.mjTEXROLE_RGB.value
    textures = [int(model.mat_texid[geom.matid[0], role]) for geom in geoms[:2]]
    kinds = [int(model.tex_type[texture]) for texture in textures]
    assert kinds == [mujoco.mjtTexture.mjTEXTURE_CUBE, mujoco.mjtTexture.mjTEXTURE_2D] and geoms[2].matid[0] == -1
    flat = model.tex_adr[textures[1]]
    assert (model.tex_data[flat : flat + QUARTERS.nbytes] == QUARTERS.ravel()).all()


def test_a_missing_texture_is_said(tmp_path: Path) -> None:
    (tmp_path / "w.sdf").write_text(WORLD)
    warnings = World.load(str(tmp_path / "w.sdf")).warnings
    assert any("a.png" in each and "visual 'box' has its plain colour" in each for each in warnings)
