"""Small mesh and image files for tests."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

ELL = ((0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2))
"""An L-shaped outline (m) of area 3, turned left."""


def write_obj(path: Path, outline: Sequence[tuple[float, float]] = ELL, height: float = 1.0) -> None:
    """Write a prism over an outline as a Wavefront OBJ with one object `ell` and polygonal faces."""
    count = len(outline)
    lines = ["o ell"]
    lines += [f"v {x} {y} {z}" for z in (0.0, height) for x, y in outline]
    for here in range(1, count + 1):
        after = here % count + 1
        lines.append(f"f {here} {after} {after + count} {here + count}")
    if outline == ELL:
        for corners in ((1, 2, 3, 4), (1, 4, 5, 6)):
            lines.append("f " + " ".join(str(corner) for corner in reversed(corners)))
            lines.append("f " + " ".join(str(corner + count) for corner in corners))
    else:
        lines.append("f " + " ".join(str(corner) for corner in range(count, 0, -1)))
        lines.append("f " + " ".join(str(corner + count) for corner in range(1, count + 1)))
    path.write_text("\n".join(lines) + "\n")


def write_stl(path: Path, corners: Sequence[Sequence[float]] = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))) -> None:
    """Write a tetrahedron as a binary STL, normals outwards."""
    points = np.array(corners, dtype=np.float64)
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    data = bytes(80) + struct.pack("<I", len(faces))
    for face in faces:
        data += struct.pack("<12f", 0, 0, 0, *points[list(face)].ravel()) + bytes(2)
    path.write_bytes(data)


def write_heightmap(path: Path, pixels: NDArray[np.uint8] | None = None) -> None:
    """Write a grey PNG; by default 9 x 9 pixels that rise from west to east."""
    if pixels is None:
        pixels = np.tile(np.linspace(0, 255, 9).astype(np.uint8), (9, 1))
    rows, columns = pixels.shape
    raw = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")
    )
