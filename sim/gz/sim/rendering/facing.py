"""The points that a camera sees on surfaces, and where these surfaces face.

All coordinates are in the camera's frame. Flat faces share a normal, so that light from far away is computed once for
each face; only round and traced surfaces have a normal for each pixel.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.rendering.shapes import ROUND, normals
from gz_course.sim.gz.sim.rendering.tile_caster import TRACED, View

Values = NDArray[np.float32]
Places = tuple[NDArray[np.intp], NDArray[np.intp]]


class Seen:
    """What some tiles of a picture show: `points` (3, tiles, pixels) [m] and their `code`, as in `View`."""

    def __init__(self, view: View, block: slice) -> None:
        surfaces = view.surfaces
        self.code = view.code[block]
        self.rays = view.tiles.rays[:, block]
        self.points: Values = self.rays * view.depth[block]
        # The last entry is for rays without a hit, whose code is -1.
        table = np.zeros((3, 8 * len(surfaces.ids) + 1), np.float32)
        for side in range(6):
            table[:, side:-1:8] = (surfaces.rotation[:, :, side // 2] * (1.0 if side % 2 else -1.0)).T
        self._table = table
        face = self.code & 7
        self._round: Places = np.nonzero((face >= ROUND) & (self.code >= 0))  # type: ignore[assignment]
        self._normal = self._of_round(view, block)

    def _of_round(self, view: View, block: slice) -> Values:
        """Return the normals (3, m) of the surfaces that are not flat, towards the camera."""
        code, surfaces = self.code[self._round], view.surfaces
        there = self.points[(slice(None), *self._round)]
        way = np.empty_like(there)
        columns, position = surfaces.columns.astype(np.float32), surfaces.position.T.astype(np.float32)
        for kind in np.unique(surfaces.kind[code >> 3]).tolist():
            rows = np.flatnonzero((surfaces.kind[code >> 3] == kind) & (code & 7 == ROUND))
            shape = code[rows] >> 3
            turn, size = columns[:, shape], surfaces.size.T[:, shape]
            from_centre = there[:, rows] - position[:, shape]
            local = tuple(
                turn[i] * from_centre[0] + turn[i + 1] * from_centre[1] + turn[i + 2] * from_centre[2]
                for i in (0, 3, 6)
            )
            x, y, z = normals(kind, (local[0], local[1], local[2]), (size[0], size[1], size[2]))
            length = np.sqrt(x * x + y * y + z * z)
            for axis in range(3):
                way[axis, rows] = (turn[axis] * x + turn[axis + 3] * y + turn[axis + 6] * z) / length
        if view.normal is not None:
            rows = np.flatnonzero(code & 7 == TRACED)
            way[:, rows] = view.normal[block][self._round][rows].T
        away = way[0] * there[0] + way[1] * there[1] + way[2] * there[2] > 0.0
        way[:, away] *= -1.0
        return way

    @cached_property
    def normal(self) -> Values:
        """The normal (3, tiles, pixels) of each pixel; 0 where nothing was hit."""
        normal = self._table[:, self.code]
        normal[(slice(None), *self._round)] = self._normal
        return normal

    def lambert(self, toward: Values) -> Values:
        """Return the cosine (tiles, pixels) between the normals and directions (3, tiles, pixels) or (3, 1, 1) to a
        light, 0 where the surface faces away or nothing was hit.
        """
        if toward.shape[1] == 1:
            x, y, z = toward[:, 0, 0]
            cosine: Values = (self._table[0] * x + self._table[1] * y + self._table[2] * z)[self.code]
            cosine[self._round] = self._normal[0] * x + self._normal[1] * y + self._normal[2] * z
        else:
            normal = self.normal
            cosine = normal[0] * toward[0]
            cosine += normal[1] * toward[1]
            cosine += normal[2] * toward[2]
        return np.maximum(cosine, np.float32(0.0), out=cosine)
