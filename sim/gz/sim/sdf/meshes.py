"""Reads mesh files as vertices, triangles and looks: STL, OBJ, glTF and, with the extra `collada`, COLLADA.

Each format has a file of its own, which reads the parts (`mesh_parts.py`) that become one mesh here. `<scale>` is not
applied here, so that a file is read once for all its sizes.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import ResourceError
from gz_course.sim.gz.sim.sdf.description import Look
from gz_course.sim.gz.sim.sdf.mesh_parts import MOST_BYTES, Part, Triangles, Vertices
from gz_course.sim.gz.sim.sdf.special_files import special_kind
from gz_course.sim.gz.sim.sdf.stl_mesh import read_stl

READABLE = (".stl", ".obj", ".dae", ".gltf", ".glb")
_UNREAD = (".ply", ".fbx", ".3ds", ".blend", ".msh", ".off", ".x3d", ".wrl")
PLAIN = Look((0.7, 0.7, 0.7, 1.0))
"""The look of a part of a mesh that has none, beside parts that have one."""
_LARGEST = 1e9  # larger coordinates come from damaged files, and their squares overflow a float32


@dataclass(frozen=True, eq=False, slots=True)
class Mesh:
    """A triangle surface: `vertices` (n, 3) float64 [m] as in the file, unscaled; `triangles` (m, 3) int32 vertex
    indices, counter-clockwise seen from outside. Both are read-only.

    `uv` (m, 3, 2), `looks` and `look` (m,) are those of `gz.sim.sdf.description.TriangleMesh`; a file without colours
    has none. `notes` are sentences about what was left out.
    """

    vertices: Vertices
    triangles: Triangles
    uv: NDArray[np.float32] | None = None
    looks: tuple[Look, ...] = ()
    look: NDArray[np.int32] | None = None
    notes: tuple[str, ...] = ()


def read_mesh(path: Path, submesh: str = "", center: bool = False) -> Mesh:
    """Read a mesh file, whose format is that of its suffix.

    `submesh` selects the part of that name (OBJ: object or group; COLLADA, glTF: node or geometry; ASCII STL: solid).
    `center` moves the selection so that the middle of its bounding box is the origin. Raises `ResourceError` with the
    file and, for text formats, the line if the file is missing, damaged, too large, empty or of another format.
    """
    kind = path.suffix.lower()
    if kind not in READABLE:
        can = "use .obj or .stl (Blender and MeshLab write both)"
        if kind in _UNREAD:
            raise ResourceError(f"{path}: meshes of kind {kind} are not read here; {can}")
        raise ResourceError(f"{path}: the file's ending '{kind}' is not that of a mesh; {can}")
    data = _bytes_of(path)
    notes: list[str] = []
    if kind == ".dae":
        vertices, parts = _collada(path, data, notes)
    elif kind == ".obj":
        from gz_course.sim.gz.sim.sdf.obj_mesh import read_obj

        vertices, parts = read_obj(path, data, notes)
    elif kind in (".gltf", ".glb"):
        from gz_course.sim.gz.sim.sdf.gltf_mesh import read_gltf

        vertices, parts = read_gltf(path, data, notes)
    else:
        vertices, parts = read_stl(path, data)
    if submesh:
        chosen = [part for part in parts if submesh in part.names]
        if not chosen:
            known = [name for part in parts for name in part.names if name]
            hint = did_you_mean(submesh, known, listing="its submeshes are")
            raise ResourceError(f"{path}: the mesh has no submesh '{submesh}'{hint}")
        parts = chosen
    return _finished(path, vertices, parts, center, notes)


def _bytes_of(path: Path) -> bytes:
    try:
        if kind := special_kind(path):
            raise ResourceError(f"{path}: a mesh is a file, but this is {kind}")
        if not path.is_file():
            siblings = [each.name for each in _listed(path.parent) if each.suffix.lower() in READABLE]
            hint = did_you_mean(path.name, siblings, listing="meshes in that folder are")
            raise ResourceError(f"{path}: there is no such mesh file{hint}")
        size = path.stat().st_size
        if size > MOST_BYTES:
            raise ResourceError(f"{path}: the mesh has {size // 2**20} MiB, at most {MOST_BYTES // 2**20} are read")
        return path.read_bytes()
    except OSError as error:
        if isinstance(error, ResourceError):
            raise
        raise ResourceError(f"{path}: the mesh file cannot be read ({error.strerror or error})") from None


def _listed(folder: Path) -> list[Path]:
    try:
        with os.scandir(folder) as entries:
            return [Path(entry.path) for entry in entries]
    except OSError:
        return []


def _finished(path: Path, vertices: Vertices, parts: Sequence[Part], center: bool, notes: Sequence[str]) -> Mesh:
    """Return the mesh of some parts: merge equal vertices, drop unused ones and triangles without area."""
    arrays = [np.asarray(part.triangles, dtype=np.int32).reshape(-1, 3) for part in parts]
    triangles = np.concatenate(arrays) if arrays else np.zeros((0, 3), np.int32)
    used, flat = np.unique(triangles, return_inverse=True)
    corners = vertices[used]
    if not np.all(np.isfinite(corners)) or np.any(np.abs(corners) > _LARGEST):
        raise ResourceError(f"{path}: the mesh has a vertex that is not finite or is farther than {_LARGEST:g} away")
    corners, merged = np.unique(corners + 0.0, axis=0, return_inverse=True)  # + 0.0 turns -0.0 into 0.0
    triangles = merged.reshape(-1)[flat.reshape(-1)].reshape(-1, 3).astype(np.int32)
    a, b, c = triangles.T
    kept = (a != b) & (b != c) & (c != a)
    triangles = triangles[kept]
    if not len(triangles):
        raise ResourceError(f"{path}: the mesh has no triangle")
    if center:
        corners = corners - (corners.min(axis=0) + corners.max(axis=0)) / 2.0
    corners.flags.writeable = triangles.flags.writeable = False
    counts = [len(array) for array in arrays]
    return Mesh(corners, triangles, _uv(parts, counts, kept), *_looks(parts, counts, kept), tuple(notes))


def _uv(parts: Sequence[Part], counts: Sequence[int], kept: NDArray[np.bool_]) -> NDArray[np.float32] | None:
    """Return the places in a texture (m, 3, 2) of the kept triangles, v downwards; None if no part has any."""
    if all(part.uv is None for part in parts):
        return None
    each = [
        np.zeros((count, 3, 2)) if part.uv is None else np.asarray(part.uv, np.float64).reshape(count, 3, 2)
        for part, count in zip(parts, counts, strict=True)
    ]
    uv = np.concatenate(each)[kept]
    uv[..., 1] = 1.0 - uv[..., 1]
    uv[~(np.abs(uv) < _LARGEST)] = 0.0
    return uv.astype(np.float32)


def _looks(
    parts: Sequence[Part], counts: Sequence[int], kept: NDArray[np.bool_]
) -> tuple[tuple[Look, ...], NDArray[np.int32] | None]:
    """Return the looks of the kept triangles and the number of each triangle's look; none if no part has one."""
    if all(part.look is None for part in parts):
        return (), None
    known: dict[Look, int] = {}
    numbers = [known.setdefault(part.look or PLAIN, len(known)) for part in parts]
    look = np.repeat(np.array(numbers, np.int32), counts)[kept]
    used, renumbered = np.unique(look, return_inverse=True)
    looks = tuple(known)
    return tuple(looks[number] for number in used.tolist()), renumbered.reshape(-1).astype(np.int32)


def _collada(path: Path, data: bytes, notes: list[str]) -> tuple[Vertices, list[Part]]:
    try:
        from gz_course.sim.gz.sim.sdf import collada_mesh
    except ImportError:
        raise ResourceError(
            f"{path}: COLLADA meshes need one more package; install it with: pip install 'gz-ros2-course[collada]'"
        ) from None
    vertices: list[Vertices] = []
    parts: list[Part] = []
    start = 0
    for names, corners, uv, look in collada_mesh.triangles_of(path, data, notes):
        vertices.append(corners)
        indices = np.arange(start, start + len(corners), dtype=np.int32).reshape(-1, 3)
        parts.append(Part(names, indices, uv, look))
        start += len(corners)
    return np.concatenate(vertices) if vertices else np.zeros((0, 3)), parts
