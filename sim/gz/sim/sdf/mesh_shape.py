"""Reads `<mesh>` of a `<geometry>`: a surface of triangles from a file, with its scale and submesh.

`gz.sim.sdf.geometry` calls it; `gz.sim.sdf.resources` opens the file, `gz.sim.sdf.convex` makes the convex pieces that
collide. Meshes of the same file, submesh and scale are read once and shared.

Source: SDFormat, element `<mesh>`, http://sdformat.org/spec?elem=geometry
"""

from __future__ import annotations

import math
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.errors import Diagnostics, ResourceError
from gz_course.sim.gz.sim.sdf.convex import convex_pieces
from gz_course.sim.gz.sim.sdf.description import Geometry, TriangleMesh
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.resources import Resources

FULLER = 0.1
"""Relative excess of the volume of a convex hull over that of its mesh above which a warning is given."""
_LARGEST = 1e6  # [m]
_LONGEST_MOVING = 20.0  # [m]; the file of a longer moving mesh is probably in millimetres
_SMALLEST_AREA = 1e-12  # [m^2]


def read_mesh_shape(
    shape: Element, owner: Element, moving: bool, diagnostics: Diagnostics, resources: Resources
) -> Geometry | None:
    """Return the mesh of a `<collision>` or `<visual>`, or None after a warning if its file cannot be used."""
    left_out = f"so <{owner.tag}> '{owner.name}' is left out"
    uri = shape.text_of("uri")
    if not uri:
        diagnostics.warn(shape.where, f"<mesh> has no <uri>, {left_out}")
        return None
    scale = shape.vector("scale", (1.0, 1.0, 1.0))
    if not all(1e-9 < abs(value) < 1e9 for value in scale):
        raise shape.error(f"the <scale> of <mesh> must not be zero or infinite, got '{shape.text_of('scale')}'")
    submesh = shape.find("submesh")
    part = submesh.text_of("name") if submesh is not None else ""
    center = submesh.flag("center", False) if submesh is not None else False
    try:
        path = resources.find_file(uri, shape.folder)
        stamp = resources.stamp(path)
        hull = shape.attributes.get("optimization") == "convex_hull"
        touching = "" if owner.tag != "collision" else "hull" if hull else "moving" if moving else "static"
        mesh, fuller, notes = _load(resources, path, stamp, part, center, (scale[0], scale[1], scale[2]), touching)
    except (ResourceError, OSError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        diagnostics.warn((shape.find("uri") or shape).where, f"{reason}, {left_out}")
        return None
    extent = np.ptp(mesh.vertices, axis=0) if len(mesh.vertices) else np.zeros(3)
    if not len(mesh.triangles) or not np.max(extent) > 0.0 or (touching and not mesh.pieces):
        diagnostics.warn(shape.where, f"the mesh {path} has no surface, {left_out}")
        return None
    if not np.max(np.abs(mesh.vertices)) < _LARGEST:
        diagnostics.warn(shape.where, f"the mesh {path} is larger than {_LARGEST:g} m, {left_out}; check its <scale>")
        return None
    if owner.tag == "visual":
        for note in notes:
            diagnostics.warn_once(note, (shape.find("uri") or shape).where, note)
    if moving and np.max(extent) > _LONGEST_MOVING:
        text = f"the mesh {path.name} is {np.max(extent):g} m long; if its file is in millimetres, add to <mesh>: "
        diagnostics.warn(shape.where, f"{text}<scale>0.001 0.001 0.001</scale>")
    if fuller > FULLER:
        text = f"<collision> '{owner.name}' touches as the convex hull of {path.name}, which is "
        text += f"{fuller:.0%} larger than the mesh" if math.isfinite(fuller) else "filled where the mesh is open"
        diagnostics.warn(shape.where, f"{text}; use boxes, cylinders or several convex meshes instead")
    return Geometry("mesh", (float(extent[0]), float(extent[1]), float(extent[2])), mesh=mesh)


@lru_cache(maxsize=256)
def _load(
    resources: Resources,
    path: Path,
    _stamp: tuple[int, ...],
    submesh: str,
    center: bool,
    scale: tuple[float, float, float],
    touching: str,
) -> tuple[TriangleMesh, float, tuple[str, ...]]:
    """Read and scale a mesh; return it with the relative excess of its convex hulls and the notes of its
    reader.

    `_stamp` changes with the content of the file, so that the cache does not return an old version.
    """
    read = resources.read_mesh(path, submesh, center)
    vertices = np.asarray(read.vertices, dtype=np.float64) * np.array(scale)
    triangles = np.asarray(read.triangles, dtype=np.int32)
    uv = read.uv
    if np.prod(np.sign(scale)) < 0.0:
        triangles = triangles[:, ::-1]  # mirroring reverses the winding order
        uv = None if uv is None else uv[:, ::-1]
    pieces: tuple[NDArray[np.float64], ...] = ()
    fuller = 0.0
    if not np.all(np.isfinite(vertices)) or _area(vertices, triangles) < _SMALLEST_AREA:
        triangles, uv = triangles[:0], None
    elif touching == "hull":
        pieces = (vertices,)
    elif touching:
        pieces, fuller = convex_pieces(vertices, triangles, moving=touching == "moving")
    seen = vertices.astype(np.float32)
    for array in (seen, triangles):
        array.flags.writeable = False
    return TriangleMesh(seen, triangles, pieces, uv, read.looks, read.look), fuller, read.notes


def _area(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> float:
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    return 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
