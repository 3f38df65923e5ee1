"""Casts the rays of a lidar into the world, on the CPU; `tile_caster` does so for cameras.

A sensor gives directions in its own frame and its near and far limits; `cast` returns the first surface that each ray
hits. As in Gazebo's renderer, rays pass through surfaces nearer than the near limit and through what `viewpoint` hides.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.physics.builder import SITE_GROUP
from gz_course.sim.gz.sim.rendering.viewpoint import ALL_BITS, Floats, Viewpoint

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.sim.sdf.description import Sensor


@dataclass(eq=False, slots=True)
class Hits:
    """The hits of `n` rays: `distance` (n,) [m] along the ray, -1 for none; `geom` (n,) MuJoCo's geom id, -1 for none;
    `origin` (3,) and `rays` (n, 3) in the world frame.
    """

    distance: Floats
    geom: NDArray[np.int32]
    origin: Floats
    rays: Floats


class RayCaster(Viewpoint):
    """The rays of one lidar: unit vectors `directions` (n, 3), constant in the sensor's frame.

    Surfaces nearer than `near` (n,) [m] along the ray are invisible; rays end at `far` [m]; `group` is the geom group
    that is visible.
    """

    def __init__(
        self,
        world: WorldAccess,
        sensor: Sensor,
        directions: Floats,
        group: int,
        near: Floats,
        far: float,
        mask: int = ALL_BITS,
    ) -> None:
        super().__init__(world, sensor, group, mask)
        self._directions = directions
        self._near = near
        self._far = far
        self._groups = np.zeros(6, dtype=np.uint8)
        self._groups[group] = 1
        count = len(directions)
        self._geom = np.zeros(count, dtype=np.int32)
        self._distance = np.zeros(count)

    def cast(self) -> Hits:
        """Cast all rays from the present pose of the sensor. The returned arrays are valid until the next cast."""
        world = self._world
        world.truth.refresh()
        model, data = world.model, world.data
        origin = data.site_xpos[self._site].copy()
        rays = self._directions @ data.site_xmat[self._site].reshape(3, 3).T
        hidden = self._hidden
        groups = model.geom_group[hidden].copy() if hidden else None
        if groups is not None:
            model.geom_group[hidden] = SITE_GROUP
        distance, geom = self._distance, self._geom
        try:
            mujoco.mj_multiRay(
                model, data, origin, rays.ravel(), self._groups, True, -1, geom, distance, None, len(rays), self._far
            )
            near = np.flatnonzero((distance >= 0.0) & (distance < self._near))
            for ray in near:
                self._recast(int(ray), origin, rays[ray])
        finally:
            if groups is not None:
                model.geom_group[hidden] = groups
        missed = (distance > self._far) | (geom < 0) | (distance < 0.0)
        distance[missed], geom[missed] = -1.0, -1
        return Hits(distance, geom, origin, rays)

    def _recast(self, ray: int, origin: Floats, direction: Floats) -> None:
        """Cast one ray again from its near limit."""
        skip = self._near[ray]
        beyond = mujoco.mj_ray(
            self._world.model, self._world.data, origin + skip * direction, direction, self._groups, True, -1,
            self._geom[ray : ray + 1], None,
        )  # fmt: skip
        self._distance[ray] = skip + beyond if beyond >= 0.0 else -1.0


def directions(horizontal: Floats, vertical: Floats) -> Floats:
    """Return unit vectors (n, 3) for angles [rad]: x forward, y left, z up; all of `horizontal` for each of
    `vertical`.
    """
    azimuth = np.tile(horizontal, len(vertical))
    elevation = np.repeat(vertical, len(horizontal))
    across = np.cos(elevation)
    return np.stack((across * np.cos(azimuth), across * np.sin(azimuth), np.sin(elevation)), axis=1)
