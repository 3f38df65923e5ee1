"""Reads STL files, binary and ASCII, as the vertices and parts of a mesh.

Source: https://www.fabbers.com/tech/STL_Format
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from gz_course.sim.gz.sim.errors import ResourceError
from gz_course.sim.gz.sim.sdf.mesh_parts import Part, Vertices, fan, numbers, rows_of

_STL_HEADER = 84
_STL_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_stl(path: Path, data: bytes) -> tuple[Vertices, list[Part]]:
    """Read binary or ASCII STL; the size decides first, because a binary file may also begin with "solid"."""
    count = int.from_bytes(data[80:_STL_HEADER], "little") if len(data) >= _STL_HEADER else -1
    expected = _STL_HEADER + count * _STL_FACET.itemsize
    if count >= 0 and expected <= len(data) and (expected == len(data) or not _looks_ascii(data)):
        facets = np.frombuffer(data, _STL_FACET, count, _STL_HEADER)
        with np.errstate(invalid="ignore"):  # a damaged number may be a signalling NaN; it is rejected below
            corners = facets["corners"].astype(np.float64).reshape(-1, 3)
        indices = np.arange(3 * count, dtype=np.int32).reshape(-1, 3)
        return corners, [Part((), indices)]
    if _looks_ascii(data):
        return _ascii_stl(path, data)
    if count < 0:
        raise ResourceError(f"{path}: this is no STL file: {len(data)} bytes are too few for a header")
    whole = max(0, len(data) - _STL_HEADER) // _STL_FACET.itemsize
    raise ResourceError(f"{path}: the STL file is cut off: it announces {count} triangles and holds {whole}")


def _looks_ascii(data: bytes) -> bool:
    head = data[:1024].lstrip().lower()
    return head.startswith(b"solid") and b"\0" not in data[:1024]


def _ascii_stl(path: Path, data: bytes) -> tuple[Vertices, list[Part]]:
    vertices: list[tuple[float, ...]] = []
    parts: list[Part] = []
    loop: list[int] | None = None
    ended = False
    for number, line in enumerate(data.decode("utf-8", "replace").splitlines(), 1):
        words = line.split()
        if not words:
            continue
        word = words[0].lower()
        if word == "solid":
            parts.append(Part((" ".join(words[1:]),), []))
            ended = False
        elif word == "outer":
            loop = []
        elif word == "vertex":
            if loop is None or not parts:
                raise ResourceError(f"{path}:{number}: 'vertex' stands outside of a loop")
            loop.append(len(vertices))
            vertices.append(numbers(path, number, words[1:4]))
        elif word == "endloop":
            if loop is None or len(loop) < 3:
                raise ResourceError(f"{path}:{number}: a loop needs three vertices, got {len(loop or ())}")
            parts[-1].add(fan(loop))
            loop = None
        elif word == "endsolid":
            ended = True
        elif word not in ("facet", "endfacet"):
            raise ResourceError(f"{path}:{number}: '{words[0][:20]}' is no word of an STL file")
    if not ended:
        raise ResourceError(f"{path}: the STL file is cut off: its last line is not 'endsolid'")
    return rows_of(vertices), parts
