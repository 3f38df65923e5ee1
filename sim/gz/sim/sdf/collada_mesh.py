"""Reads the triangles of COLLADA files (.dae): the geometries of the visual scene, transformed by their nodes, and the
diffuse colours and textures of their materials.

`gz.sim.sdf.meshes` reports a missing `pycollada` (extra `collada`). As in Gazebo the unit of the file
(`<unit meter=...>`) is applied but not its `<up_axis>`: z in the file is z in the world.

Source: COLLADA 1.4.1 specification, https://www.khronos.org/files/collada_spec_1_4.pdf
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import unquote

import collada
import collada.material
import collada.scene
import numpy as np
from collada.common import DaeBrokenRefError, DaeIncompleteError, DaeMalformedError, DaeUnsupportedError
from numpy.typing import NDArray

from gz_course.sim.gz.sim.errors import ResourceError
from gz_course.sim.gz.sim.sdf.description import Look
from gz_course.sim.gz.sim.sdf.textures import read_texture

LookOf = Callable[[object], Look | None]

Corners = NDArray[np.float64]
Part = tuple[tuple[str, ...], Corners, Corners | None, Look | None]
"""Names (innermost named node, geometry), corners (3 m, 3) [m], their places in a texture (3 m, 2), and the look."""
_QUOTED = re.compile(rb'="[^"]*"')
_DEEPEST = 200
_MOST_INSTANCES = 100_000


def triangles_of(path: Path, data: bytes, notes: list[str]) -> list[Part]:
    """Return the parts of a COLLADA file, three corners for each triangle; `notes` takes sentences about what was left
    out. Raises ResourceError if it cannot be read.
    """
    parts: list[Part]
    looks: dict[object, Look | None] = {}

    def look_of(material: object) -> Look | None:
        if id(material) not in looks:
            looks[id(material)] = _look(path, material, notes)
        return looks[id(material)]

    try:
        document = _document(data)
        if document.scene is None:
            # Without a scene there are no instances: geometries keep their own coordinates.
            parts = [
                ((each.name or each.id,), corners, uv, None)
                for each in document.geometries
                for corners, uv, _ in _primitives(each)
            ]
        else:
            left = [_MOST_INSTANCES]
            walks = (_walk(path, node, np.eye(4), "", 0, left, look_of) for node in document.scene.nodes)
            parts = [part for walk in walks for part in walk]
        scale = document.assetInfo.unitmeter or 1.0
    except (ResourceError, MemoryError):
        raise
    except Exception as error:  # pycollada lets errors of its parsers and of numpy through
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise ResourceError(f"{path}: the COLLADA file cannot be read ({reason})") from None
    return [(names, corners * scale, uv, look) for names, corners, uv, look in parts if len(corners)]


def _document(data: bytes) -> collada.Collada:
    """Return what a file holds; the exporter of assimp writes `<` into attributes, which is no XML."""
    # Unsupported elements are effects and cameras; a broken reference or an incomplete image is a missing texture.
    ignored = [DaeUnsupportedError, DaeBrokenRefError, DaeIncompleteError]
    try:
        return collada.Collada(io.BytesIO(data), ignore=ignored)
    except DaeMalformedError:
        escaped = _QUOTED.sub(lambda found: found[0].replace(b"<", b"&lt;"), data)
        if escaped == data:
            raise
        return collada.Collada(io.BytesIO(escaped), ignore=ignored)


def _walk(
    path: Path, node: object, matrix: Corners, name: str, depth: int, left: list[int], look_of: LookOf
) -> Iterator[Part]:
    """Yield the geometries below a node; a node without a name inherits that of its parent."""
    left[0] -= 1
    if left[0] < 0 and depth <= _DEEPEST:
        raise ResourceError(
            f"{path}: the COLLADA file has more than {_MOST_INSTANCES} instances of nodes and geometries"
        )
    if depth > _DEEPEST:
        raise ResourceError(
            f"{path}: the nodes of the COLLADA file are nested too deeply or name each other in a circle"
        )
    if isinstance(node, collada.scene.NodeNode):
        yield from _walk(path, node.node, matrix, name, depth + 1, left, look_of)
    elif isinstance(node, collada.scene.Node):
        own = node.name or (node.xmlnode.get("name") if node.xmlnode is not None else None) or name
        below = matrix @ np.asarray(node.matrix, dtype=np.float64)
        for child in node.children:
            yield from _walk(path, child, below, own, depth + 1, left, look_of)
    elif isinstance(node, collada.scene.GeometryNode | collada.scene.ControllerNode):
        geometry = node.geometry if isinstance(node, collada.scene.GeometryNode) else node.controller.geometry
        materials = {each.symbol: each.target for each in node.materials}
        mirrored = np.linalg.det(matrix[:3, :3]) < 0.0  # a reflection reverses the winding order
        for corners, uv, symbol in _primitives(geometry):
            moved = corners @ matrix[:3, :3].T + matrix[:3, 3]
            if mirrored:
                moved = moved.reshape(-1, 3, 3)[:, ::-1].reshape(-1, 3)
                uv = None if uv is None else uv.reshape(-1, 3, 2)[:, ::-1].reshape(-1, 2)
            yield (name, geometry.name or geometry.id), moved, uv, look_of(materials.get(symbol))


def _primitives(geometry: collada.geometry.Geometry) -> Iterator[tuple[Corners, Corners | None, str | None]]:
    """Yield corners, their places in a texture, and the name of the material of each set of triangles."""
    for primitive in geometry.primitives:
        triangles = primitive.triangleset() if hasattr(primitive, "triangleset") else primitive
        if not isinstance(triangles, collada.triangleset.TriangleSet) or triangles.vertex_index is None:
            continue  # lines have no surface
        corners = np.asarray(triangles.vertex, np.float64)[triangles.vertex_index].reshape(-1, 3)
        uv = None
        if triangles.texcoordset and len(triangles.texcoordset[0]):
            places = np.asarray(triangles.texcoordset[0], np.float64)[:, :2]
            uv = places[triangles.texcoord_indexset[0]].reshape(-1, 2)
        yield corners, uv, primitive.material


def _look(path: Path, material: object, notes: list[str]) -> Look | None:
    """Return the diffuse colour and texture of a material, or None if it has neither."""
    effect = getattr(material, "effect", None)
    diffuse = getattr(effect, "diffuse", None)
    if isinstance(diffuse, collada.material.Map):
        name = unquote(str(diffuse.sampler.surface.image.path)).removeprefix("file://").replace("\\", "/")
        try:
            return Look((1.0, 1.0, 1.0, 1.0), read_texture(path.parent / name))
        except ResourceError as error:
            notes.append(str(error))
            return None
    if not isinstance(diffuse, tuple | list) or len(diffuse) < 3:
        return None
    red, green, blue = (min(1.0, max(0.0, float(value))) for value in diffuse[:3])
    return Look((red, green, blue, 1.0))
