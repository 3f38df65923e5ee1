"""Where a lidar or camera looks from, and which geoms it does not see.

A sensor does not see the parts of its own model that enclose it (its housing), nor parts whose `visibility_flags` share
no bit with its `visibility_mask`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.physics.builder import VISUAL_GROUP
from gz_course.sim.gz.sim.rendering.geom_parts import geom_parts

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.sim.sdf.description import Sensor

Floats = NDArray[np.float64]
ALL_BITS = 0xFFFFFFFF


class Viewpoint:
    """The place of one sensor, which sees the geom group `group`."""

    def __init__(self, world: WorldAccess, sensor: Sensor, group: int, mask: int = ALL_BITS) -> None:
        self._world = world
        self._sensor = sensor
        self._group = group
        self._mask = mask

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
            for geom, _, _, part, _ in geom_parts(self._world, VISUAL_GROUP)
            if not part.element.mask("visibility_flags", ALL_BITS) & self._mask
        ]

    def pose(self) -> tuple[Floats, Floats]:
        """Return the present pose in the world: position (3,) [m] and quaternion (4,) (wxyz)."""
        self._world.truth.refresh()
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, self._world.data.site_xmat[self._site])
        return self._world.data.site_xpos[self._site].copy(), quaternion


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
