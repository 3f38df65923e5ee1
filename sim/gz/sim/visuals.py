"""What a world looks like: every `<visual>` as a plain shape, for recordings and viewers.

`Truth.geometry` lists these once; `Truth.link_pose` tells where their links are.
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

    `kind` is box, sphere, cylinder, capsule, ellipsoid, cone, plane, mesh, polyline or heightmap. `size` holds full
    extents in metres along the shape's own axes: box (x, y, z); sphere (d, d, d); cylinder (d, d, length); capsule
    (d, d, length without its caps); ellipsoid (2 rx, 2 ry, 2 rz); cone (d, d, height); plane (x, y, 0); others their
    bounding box. Cylinders, capsules and cones stand along z, a plane's normal is z: a `<normal>` is already part of
    `pose`. `pose` is the shape in its link's frame, `rgba` its colour (each 0..1).

    `vertices` (n, 3) float32 in metres in the shape's own frame and `triangles` (m, 3) int32 are the surface of a cone,
    mesh, polyline or heightmap, None for the other kinds. Equal meshes are the same arrays; they cannot be written to.
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
