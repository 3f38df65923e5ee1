"""What the readers of mesh files have in common: the parts of a mesh, and vertices that a line of text holds."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.errors import ResourceError
from gz_course.sim.gz.sim.sdf.description import Look

Vertices = NDArray[np.float64]
Triangles = NDArray[np.int32]

MOST_BYTES = 256 * 1024 * 1024  # of a mesh file


@dataclass(eq=False)
class Part:
    """Triangles and the names of their part: an OBJ group or object, a solid, a COLLADA node.

    `uv` are the places of their corners in a texture, in the file's own direction (v upwards), `look` their appearance.
    """

    names: tuple[str, ...]
    triangles: list[tuple[int, int, int]] | Triangles
    uv: list[tuple[tuple[float, float], ...]] | NDArray[np.float64] | None = None
    look: Look | None = None

    def add(self, triangles: Iterable[tuple[int, int, int]]) -> None:
        """Add triangles to a part whose triangles are a list."""
        assert isinstance(self.triangles, list)
        self.triangles.extend(triangles)


def fan(corners: Sequence[int]) -> Iterable[tuple[int, int, int]]:
    return [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]


def numbers(path: Path, line: int, words: list[str]) -> tuple[float, ...]:
    try:
        values = tuple(map(float, words))
    except ValueError:
        values = ()
    if len(values) != 3 or not all(map(math.isfinite, values)):
        raise ResourceError(f"{path}:{line}: a vertex needs 3 finite numbers, got '{' '.join(words)[:60]}'")
    return values


def rows_of(vertices: list[tuple[float, ...]]) -> Vertices:
    return np.array(vertices, dtype=np.float64).reshape(-1, 3)
