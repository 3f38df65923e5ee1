"""The visible shapes of a world as plain data, for recordings and viewers.

`Truth.geometry` returns them; they do not change. `Truth.link_pose` returns the poses of their links.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.pose import Pose, quaternion_between
from gz_course.sim.gz.sim.sdf.description import WorldDescription


@dataclass(frozen=True, eq=False, slots=True)
class VisualShape:
    """One visible shape, fixed to a link.

    `kind` is box, sphere, cylinder, capsule, ellipsoid, cone, plane, mesh, polyline or heightmap. `size` [m] holds full
    extents along the shape's own axes: box (x, y, z); sphere (d, d, d); cylinder (d, d, length); capsule (d, d, length
    without its caps); ellipsoid (2 rx, 2 ry, 2 rz); cone (d, d, height); plane (x, y, 0); bounding box for the others.
    The axis of cylinders, capsules and cones is z, and so is a plane's normal: a `<normal>` is already part of `pose`.
    `pose` is that of the shape in its link's frame; values of `rgba` are 0..1.

    `vertices` (n, 3) float32 [m] in the shape's own frame and `triangles` (m, 3) int32 are the surface of a cone, mesh,
    polyline or heightmap, None for the other kinds. Equal meshes share the same read-only arrays.
    """

    model: str
    link: str
    name: str
    kind: str
    size: tuple[float, float, float]
    pose: Pose
    rgba: tuple[float, float, float, float]
    static: bool
    vertices: NDArray[np.float32] | None = None
    triangles: NDArray[np.int32] | None = None


def visual_shapes(world: WorldDescription) -> list[VisualShape]:
    """Return all visible shapes of a world in file order."""
    shapes: list[VisualShape] = []
    for model in world.models:
        for link in model.links:
            for visual in link.visuals:
                geometry = visual.geometry
                pose = visual.pose
                if geometry.kind == "plane":
                    pose = pose * Pose(quaternion=quaternion_between((0.0, 0.0, 1.0), geometry.normal))
                shapes.append(
                    VisualShape(
                        model.name,
                        link.name,
                        visual.name,
                        geometry.kind,
                        geometry.size,
                        pose,
                        visual.rgba,
                        model.static,
                        None if geometry.mesh is None else geometry.mesh.vertices,
                        None if geometry.mesh is None else geometry.mesh.triangles,
                    )
                )
    return shapes
