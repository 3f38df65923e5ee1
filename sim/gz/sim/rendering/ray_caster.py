"""Casts the rays of a lidar or camera into the world, on the CPU.

A sensor gives directions in its own frame and its near and far limits; `cast` returns the first surface that each ray
hits. As in Gazebo's renderer, rays pass through surfaces nearer than the near limit, surfaces seen from inside (the
housing of the sensor), and parts whose `visibility_flags` share no bit with the sensor's `visibility_mask`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.physics.builder import SITE_GROUP, VISUAL_GROUP
from gz_course.sim.gz.sim.rendering.geom_parts import geom_parts

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.sim.sdf.description import Sensor

Floats = NDArray[np.float64]
ALL_BITS = 0xFFFFFFFF


@dataclass(eq=False, slots=True)
class Hits:
    """The hits of `n` rays: `distance` (n,) [m] along the ray, -1 for none; `geom` (n,) MuJoCo's geom id, -1 for none;
    `normal` (n, 3) of the surface, or None if not requested; `origin` (3,) and `rays` (n, 3) in the world frame.
    """

    distance: Floats
    geom: NDArray[np.int32]
    normal: Floats | None
    origin: Floats
    rays: Floats


class RayCaster:
    """The rays of one sensor: unit vectors `directions` (n, 3), constant in the sensor's frame.

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
        self._world = world
        self._sensor = sensor
        self._directions = directions
        self._near = near
        self._far = far
        self._group = group
        self._mask = mask
        self._groups = np.zeros(6, dtype=np.uint8)
        self._groups[group] = 1
        count = len(directions)
        self._geom = np.zeros(count, dtype=np.int32)
        self._distance = np.zeros(count)
        self._normal = np.zeros(3 * count)

    def bind(self) -> None:
        """Find the site and the geoms invisible to this sensor in MuJoCo's new model."""
        sensor = self._sensor
        self._site = self._world.model.site(f"{sensor.model}::{sensor.link}::{sensor.name}").id
        self._hidden = sorted({*self._find_enclosing(), *self._find_masked()})

    def _find_enclosing(self) -> list[int]:
        """Return the geoms of the sensor's own model that contain its origin."""
        world, model, data = self._world, self._world.model, self._world.data
        world.truth.refresh()
        origin = data.site_xpos[self._site]
        prefix = self._sensor.model + "::"
        found = []
        for geom in range(model.ngeom):
            if model.geom_group[geom] == self._group and model.geom(geom).name.startswith(prefix):
                local = data.geom_xmat[geom].reshape(3, 3).T @ (origin - data.geom_xpos[geom])
                kind = int(model.geom_type[geom])
                if kind == mujoco.mjtGeom.mjGEOM_MESH:
                    inside = self._mesh_surrounds(geom, origin)
                else:
                    inside = _contains(kind, model.geom_size[geom], local)
                if inside:
                    found.append(geom)
        return found

    def _mesh_surrounds(self, geom: int, origin: Floats) -> bool:
        """Tell whether rays in all six directions along the world axes hit a mesh."""
        model, data = self._world.model, self._world.data
        axes = np.concatenate((np.eye(3), -np.eye(3)))
        return all(mujoco.mj_rayMesh(model, data, geom, origin, axis, None) >= 0.0 for axis in axes)

    def _find_masked(self) -> list[int]:
        """Return the visuals whose flags share no bit with the sensor's mask."""
        if self._mask == ALL_BITS or self._group != VISUAL_GROUP:
            return []
        return [
            geom
            for geom, _, _, part in geom_parts(self._world, VISUAL_GROUP)
            if not part.element.integer("visibility_flags", ALL_BITS) & self._mask
        ]

    def cast(self, *, normals: bool = False) -> Hits:
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
        normal = self._normal if normals else None
        distance, geom = self._distance, self._geom
        try:
            mujoco.mj_multiRay(
                model, data, origin, rays.ravel(), self._groups, True, -1, geom, distance, normal, len(rays), self._far
            )
            near = np.flatnonzero((distance >= 0.0) & (distance < self._near))
            for ray in near:
                self._recast(int(ray), origin, rays[ray], normal)
        finally:
            if groups is not None:
                model.geom_group[hidden] = groups
        distance[(distance > self._far) | (geom < 0)] = -1.0
        geom[distance < 0.0] = -1
        return Hits(distance, geom, None if normal is None else normal.reshape(-1, 3), origin, rays)

    def _recast(self, ray: int, origin: Floats, direction: Floats, normal: Floats | None) -> None:
        """Cast one ray again from its near limit."""
        skip = self._near[ray]
        one = normal[3 * ray : 3 * ray + 3] if normal is not None else None
        beyond = mujoco.mj_ray(
            self._world.model, self._world.data, origin + skip * direction, direction, self._groups, True, -1,
            self._geom[ray : ray + 1], one,
        )  # fmt: skip
        self._distance[ray] = skip + beyond if beyond >= 0.0 else -1.0

    def pose(self) -> tuple[Floats, Floats]:
        """Return the present pose in the world: position (3,) [m] and quaternion (4,) (wxyz)."""
        self._world.truth.refresh()
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, self._world.data.site_xmat[self._site])
        return self._world.data.site_xpos[self._site].copy(), quaternion


def directions(horizontal: Floats, vertical: Floats) -> Floats:
    """Return unit vectors (n, 3) for angles [rad]: x forward, y left, z up; all of `horizontal` for each of
    `vertical`.
    """
    azimuth = np.tile(horizontal, len(vertical))
    elevation = np.repeat(vertical, len(horizontal))
    across = np.cos(elevation)
    return np.stack((across * np.cos(azimuth), across * np.sin(azimuth), np.sin(elevation)), axis=1)


def _contains(kind: int, size: Floats, point: Floats) -> bool:
    """Tell whether a primitive geom with half sizes `size` contains a point given in its own frame."""
    geom = mujoco.mjtGeom
    x, y, z = (float(value) for value in point)
    if kind == geom.mjGEOM_SPHERE:
        return bool(x * x + y * y + z * z < size[0] ** 2)
    if kind == geom.mjGEOM_BOX:
        return bool(np.all(np.abs(point) < size))
    if kind == geom.mjGEOM_CYLINDER:
        return bool(x * x + y * y < size[0] ** 2 and abs(z) < size[1])
    if kind == geom.mjGEOM_CAPSULE:
        cap = max(0.0, abs(z) - float(size[1]))
        return bool(x * x + y * y + cap * cap < size[0] ** 2)
    if kind == geom.mjGEOM_ELLIPSOID:
        return float(np.sum((point / size) ** 2)) < 1.0
    return False
