"""The part of a solid that lies below a level: its volume and the centre of that volume.

Buoyancy calls `Solid.below` for the surfaces between layers of fluid. Spheres are cut exactly, all other shapes as
closed surfaces of triangles; the circle of a cylinder has as many corners as `_CORNERS`, at the radius at which the
volume is exact.

Source: https://en.wikipedia.org/wiki/Spherical_cap; divergence theorem for the volume within a surface
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.pose import Vector
from gz_course.sim.gz.sim.sdf.description import Geometry
from gz_course.sim.gz.sim.sdf.inertia import solid

Points = NDArray[np.float64]
_CORNERS = 48
_SIGNS = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
_FACES = np.array(
    (
        *((0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)),
        *((2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)),
    )
)


class Solid:
    """One shape in its own frame: `volume` [m^3], `centre` [m] of the volume, and `reach` [m], the distance from the
    origin to its farthest point.
    """

    def __init__(self, geometry: Geometry) -> None:
        """Take a shape. Raises ValueError if it has no volume, or if its parts below a level are unknown."""
        found = solid(geometry)
        if found is None:
            raise ValueError(geometry.kind)
        self.volume, self.centre, _ = found
        self._radius = geometry.size[0] / 2.0 if geometry.kind == "sphere" else 0.0
        self._corners = np.zeros((0, 3, 3)) if self._radius else _triangles(geometry)
        self.reach = self._radius or float(np.linalg.norm(self._corners, axis=2).max())

    def below(self, level: float, position: Vector, turn: Points) -> tuple[float, Vector]:
        """Return volume [m^3] and centre (3,) [m] of the part below the height `level` [m] of the world; `position` [m]
        and rotation matrix `turn` (3, 3) place the shape. The centre of nothing is the position.
        """
        height = level - float(position[2])
        if height >= self.reach:
            return self.volume, position + turn @ self.centre
        if height <= -self.reach:
            return 0.0, position
        if self._radius:
            return _cap(self._radius, height, position)
        volume, centre = _cut(self._corners @ turn.T, height)
        return volume, position + centre


def _cap(radius: float, height: float, position: Vector) -> tuple[float, Vector]:
    deep = radius + height
    volume = math.pi * deep * deep * (3.0 * radius - deep) / 3.0
    lower = 0.75 * (2.0 * radius - deep) ** 2 / (3.0 * radius - deep)
    return volume, position - np.array((0.0, 0.0, lower))


def _cut(corners: Points, level: float) -> tuple[float, Vector]:
    """Sum the tetrahedra between the parts of the triangles (n, 3, 3) below z = `level` and a point of that plane."""
    above = corners[:, :, 2] > level
    count = above.sum(axis=1)
    parts = [corners[count == 0]]
    for number in (1, 2):
        rows = np.flatnonzero(count == number)
        if len(rows) == 0:
            continue
        # The corner that is alone on its side comes first; the order of the corners stays.
        alone = (above[rows] if number == 1 else ~above[rows]).argmax(axis=1)
        a, b, c = (corners[rows, (alone + shift) % 3] for shift in range(3))
        to_b, to_c = (a + ((level - a[:, 2]) / (end[:, 2] - a[:, 2]))[:, None] * (end - a) for end in (b, c))
        if number == 2:
            parts.append(np.stack((a, to_b, to_c), axis=1))
        else:
            parts += [np.stack((to_b, b, c), axis=1), np.stack((to_b, c, to_c), axis=1)]
    inside = np.concatenate(parts) - (0.0, 0.0, level)
    signed = np.einsum("ij,ij->i", inside[:, 0], np.cross(inside[:, 1], inside[:, 2])) / 6.0
    volume = float(signed.sum())
    if abs(volume) < 1e-15:
        return 0.0, np.array((0.0, 0.0, level))
    centre: Vector = np.einsum("i,ikj->j", signed, inside) / (4.0 * volume)
    # A surface turned inside out has a negative volume and the same centre.
    return abs(volume), centre + np.array((0.0, 0.0, level))


def _triangles(geometry: Geometry) -> Points:
    """Return the corners (n, 3, 3) of the surface of a shape, seen counterclockwise from outside."""
    size = np.array(geometry.size)
    if geometry.kind == "box":
        return (_SIGNS * size)[_FACES]
    if geometry.kind == "cylinder":
        turns = np.linspace(0.0, 2.0 * math.pi, _CORNERS, endpoint=False)
        # A regular polygon of this radius has the area of the circle.
        radius = size[0] / 2.0 * math.sqrt(2.0 * math.pi / (_CORNERS * math.sin(2.0 * math.pi / _CORNERS)))
        x, y, z = radius * np.cos(turns), radius * np.sin(turns), np.full(_CORNERS, size[2] / 2.0)
        top, bottom = np.stack((x, y, z), axis=1), np.stack((x, y, -z), axis=1)
        after, under = np.roll(top, -1, axis=0), np.roll(bottom, -1, axis=0)
        up = np.tile((0.0, 0.0, size[2] / 2.0), (_CORNERS, 1))
        sides = [(top, bottom, under), (top, under, after), (up, top, after), (-up, under, bottom)]
        return np.concatenate([np.stack(each, axis=1) for each in sides])
    if geometry.mesh is not None and geometry.kind != "heightmap":
        return geometry.mesh.vertices.astype(np.float64)[geometry.mesh.triangles]
    raise ValueError(geometry.kind)
