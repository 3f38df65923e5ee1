"""Cuts a picture into square tiles, which are tested against whole shapes before their pixels are.

Arrays of pixels are (tiles, pixels of a tile). Squares at the right and lower edge repeat the last column and row.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.rendering.viewpoint import Floats

_MANY_PIXELS = 160_000
_SIDES = 8, 16
"""The side of a tile [px], for small pictures and for those with many pixels."""


class Tiles:
    """The tiles of one camera; `directions` (n, 3) are the unit vectors of its pixels, row-major."""

    def __init__(self, width: int, height: int, directions: Floats, near: Floats, far: Floats) -> None:
        self.side = _SIDES[width * height > _MANY_PIXELS]
        self._size = width, height
        self.down, self.across = -(-height // self.side), -(-width // self.side)
        self.count = self.down * self.across
        index = np.arange(width * height).reshape(height, width)
        more = (0, self.down * self.side - height), (0, self.across * self.side - width)
        cut = np.pad(index, more, mode="edge").reshape(self.down, self.side, self.across, self.side)
        self._pixels = cut.transpose(0, 2, 1, 3).reshape(self.count, -1)
        self.rays = np.ascontiguousarray(np.moveaxis(directions[self._pixels], 2, 0), dtype=np.float32)
        """The directions (3, tiles, pixels) in the camera's frame."""
        self.near, self.far = self.cut(near), self.cut(far)
        middle = index[height // 2]
        ahead = directions[middle[width // 2]], directions[middle[max(width // 2 - 1, 0)]]
        self.pixel = float(np.linalg.norm(ahead[0] - ahead[1])) or 1.0
        """The angle [rad] between neighbouring pixels in the middle of the picture."""
        mean = directions[self._pixels].mean(axis=1)
        self.axes = mean / np.linalg.norm(mean, axis=1, keepdims=True)
        """The middle of each tile (tiles, 3), as a unit vector."""
        cosine = np.einsum("tpi,ti->tp", directions[self._pixels], self.axes).min(axis=1)
        self.angles = np.arccos(np.clip(cosine, -1.0, 1.0)) + 1e-4
        """The largest angle [rad] between the middle of a tile and its pixels."""

    def cut(self, values: Floats) -> NDArray[np.float32]:
        """Return row-major values (n,) in the order of the tiles (tiles, pixels)."""
        return np.ascontiguousarray(values[self._pixels], dtype=np.float32)

    def joined(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return values (tiles, pixels, ...) of all tiles in row-major order (n, ...)."""
        (width, height), rest = self._size, values.shape[2:]
        grid = values.reshape(self.down, self.across, self.side, self.side, *rest).swapaxes(1, 2)
        whole = grid.reshape(self.down * self.side, self.across * self.side, *rest)
        return whole[:height, :width].reshape(width * height, *rest)
