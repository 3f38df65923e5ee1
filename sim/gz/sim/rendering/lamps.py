"""The lights of a world as a camera sees them: how strongly each lights a point.

All coordinates are in the camera's frame. Attenuation is 1 / (constant + linear d + quadratic d^2) at the distance d
[m]; the light ends at its range. A spot light is full inside its inner angle, nothing outside its outer angle, and
follows the falloff between them.

Source: SDFormat, element `<light>` (attenuation, spot), http://sdformat.org/spec?elem=light
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.rendering.viewpoint import Floats

Values = NDArray[np.float32]


@dataclass(eq=False)
class Lamp:
    """One light that is on: it shines from `position` [m], or from far away if that is None, along `direction`."""

    position: Floats | None
    direction: Floats
    diffuse: Values
    specular: Values
    attenuation: tuple[float, float, float]
    range: float
    cone: tuple[float, float, float] | None
    """The cosines of half the inner and half the outer angle of a spot light, and its falloff."""
    casts: bool

    def toward(self, points: Values) -> tuple[Values, Values | None]:
        """Return the directions (3, t, p) from points to the light, or (3, 1, 1), and the distances [m]."""
        if self.position is None:
            return -self.direction.astype(np.float32).reshape(3, 1, 1), None
        way = self.position.astype(np.float32).reshape(3, 1, 1) - points
        distance = np.sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2])
        np.maximum(distance, np.float32(1e-6), out=distance)
        way /= distance
        return way, distance

    def fade(self, toward: Values, distance: Values | None, strength: Values) -> None:
        """Weaken `strength` (t, p) by attenuation, range and cone."""
        if distance is not None:
            constant, linear, quadratic = (np.float32(value) for value in self.attenuation)
            strength /= np.maximum(constant + distance * (linear + distance * quadratic), np.float32(1e-3))
            strength[distance > self.range] = 0.0
        if self.cone is not None:
            inner, outer, falloff = self.cone
            x, y, z = self.direction.astype(np.float32)
            cosine = -(toward[0] * x + toward[1] * y + toward[2] * z)
            inside = np.clip((cosine - np.float32(outer)) / np.float32(max(inner - outer, 1e-6)), 0.0, 1.0)
            strength *= np.where(inside > 0.0, inside ** np.float32(falloff), np.float32(0.0))
