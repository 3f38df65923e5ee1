"""Reads the triangles of COLLADA files (.dae): the geometries of the visual scene, transformed by their nodes.

`gz.sim.sdf.meshes` reports a missing `pycollada` (extra `collada`). As in Gazebo the unit of the file
(`<unit meter=...>`) is applied but not its `<up_axis>`: z in the file is z in the world.

Source: COLLADA 1.4.1 specification, https://www.khronos.org/files/collada_spec_1_4.pdf
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path

import collada
import collada.scene
import numpy as np
from collada.common import DaeBrokenRefError, DaeUnsupportedError
from numpy.typing import NDArray

from gz_course.sim.gz.sim.errors import ResourceError

Corners = NDArray[np.float64]
Part = tuple[tuple[str, ...], Corners]
_DEEPEST = 200
_MOST_INSTANCES = 100_000


def triangles_of(path: Path, data: bytes) -> list[Part]:
    """Return the parts of a COLLADA file: names (innermost named node, geometry) and corners (3 m, 3) float64 [m],
    three rows per triangle. Raises ResourceError if it cannot be read.
    """
    parts: list[Part]
    try:
        # Unsupported elements are effects and cameras; a broken reference is mostly a missing texture.
        document = collada.Collada(io.BytesIO(data), ignore=[DaeUnsupportedError, DaeBrokenRefError])
        if document.scene is None:
            # Without a scene there are no instances: geometries keep their own coordinates.
            parts = [((each.name or each.id,), _corners(each)) for each in document.geometries]
        else:
            left = [_MOST_INSTANCES]
            parts = [part for node in document.scene.nodes for part in _walk(path, node, np.eye(4), "", 0, left)]
        scale = document.assetInfo.unitmeter or 1.0
    except (ResourceError, MemoryError):
        raise
    except Exception as error:  # pycollada lets errors of its parsers and of numpy through
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise ResourceError(f"{path}: the COLLADA file cannot be read ({reason})") from None
    return [(names, corners * scale) for names, corners in parts if len(corners)]


def _walk(path: Path, node: object, matrix: Corners, name: str, depth: int, left: list[int]) -> Iterator[Part]:
    """Yield the geometries below a node; a node without a name inherits that of its parent."""
    left[0] -= 1
    if depth > _DEEPEST or left[0] < 0:
        raise ResourceError(
            f"{path}: the nodes of the COLLADA file are nested too deeply or name each other in a circle"
        )
    if isinstance(node, collada.scene.NodeNode):
        yield from _walk(path, node.node, matrix, name, depth + 1, left)
    elif isinstance(node, collada.scene.Node):
        own = node.name or (node.xmlnode.get("name") if node.xmlnode is not None else None) or name
        below = matrix @ np.asarray(node.matrix, dtype=np.float64)
        for child in node.children:
            yield from _walk(path, child, below, own, depth + 1, left)
    elif isinstance(node, collada.scene.GeometryNode | collada.scene.ControllerNode):
        geometry = node.geometry if isinstance(node, collada.scene.GeometryNode) else node.controller.geometry
        corners = _corners(geometry)
        moved = corners @ matrix[:3, :3].T + matrix[:3, 3]
        if np.linalg.det(matrix[:3, :3]) < 0.0:  # a reflection reverses the winding order
            moved = moved.reshape(-1, 3, 3)[:, ::-1].reshape(-1, 3)
        yield (name, geometry.name or geometry.id), moved


def _corners(geometry: collada.geometry.Geometry) -> Corners:
    found: list[Corners] = []
    for primitive in geometry.primitives:
        triangles = primitive.triangleset() if hasattr(primitive, "triangleset") else primitive
        if not isinstance(triangles, collada.triangleset.TriangleSet) or triangles.vertex_index is None:
            continue  # lines have no surface
        found.append(np.asarray(triangles.vertex, np.float64)[triangles.vertex_index].reshape(-1, 3))
    return np.concatenate(found) if found else np.zeros((0, 3))
