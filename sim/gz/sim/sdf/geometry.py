"""Reads `<geometry>` of a `<collision>` or `<visual>`: its shape and size.

Meshes, heightmaps and polylines are read by files of their own. A shape that cannot be built is left out with a
warning.

Source: SDFormat, element `<geometry>`, http://sdformat.org/spec?elem=geometry
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.sdf.description import Geometry, TriangleMesh
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.heightmap import read_heightmap
from gz_course.sim.gz.sim.sdf.mesh_shape import read_mesh_shape
from gz_course.sim.gz.sim.sdf.polyline import read_polyline
from gz_course.sim.gz.sim.sdf.resources import Resources

SHAPES = ("box", "sphere", "cylinder", "capsule", "ellipsoid", "cone", "plane", "mesh", "heightmap", "polyline")
_LARGEST = 1e6  # [m]
_SMALLEST = 1e-7
_SIDES = 32  # of a cone


def read_geometry(owner: Element, moving: bool, diagnostics: Diagnostics, resources: Resources) -> Geometry | None:
    """Return the shape of a `<collision>` or `<visual>`, or None after a warning if it has none that can be built.

    `moving` tells whether the link can move.
    """
    holder = owner.find("geometry")
    shapes = list(holder.all(*SHAPES, "image", "empty")) if holder else []
    if holder is None or not shapes:
        diagnostics.warn(owner.where, f"<{owner.tag}> '{owner.name}' has no <geometry> with a shape, it is left out")
        return None
    shape = shapes[0]
    if shape.tag == "empty":
        return None
    if shape.tag == "mesh":
        return read_mesh_shape(shape, owner, moving, diagnostics, resources)
    if shape.tag == "heightmap":
        return read_heightmap(shape, owner, moving, diagnostics, resources)
    if shape.tag == "image":
        text = f"<image> geometry is not simulated here, so <{owner.tag}> '{owner.name}' is left out; use boxes"
        diagnostics.warn(shape.where, text)
        return None
    if shape.tag == "polyline":
        made = read_polyline([each for each in shapes if each.tag == "polyline"])
        if made is None:
            text = f"<polyline> crosses or touches itself, so <{owner.tag}> '{owner.name}' is left out"
            diagnostics.warn(shape.where, text)
        return made
    return _primitive(shape)


def _primitive(shape: Element) -> Geometry:
    if shape.tag == "box":
        size = shape.vector("size", (1.0, 1.0, 1.0))
        return Geometry("box", _positive(shape, "size", size))
    if shape.tag == "sphere":
        diameter = 2.0 * shape.number("radius", 1.0)
        return Geometry("sphere", _positive(shape, "radius", (diameter, diameter, diameter)))
    if shape.tag in ("cylinder", "capsule", "cone"):
        diameter = 2.0 * shape.number("radius", 0.5)
        size = _positive(shape, "radius and length", (diameter, diameter, shape.number("length", 1.0)))
        return Geometry(shape.tag, size, mesh=_cone(size) if shape.tag == "cone" else None)
    if shape.tag == "ellipsoid":
        radii = shape.vector("radii", (1.0, 1.0, 1.0))
        return Geometry("ellipsoid", _positive(shape, "radii", tuple(2.0 * radius for radius in radii)))
    extent = shape.vector("size", (1.0, 1.0))
    x, y, z = shape.vector("normal", (0.0, 0.0, 1.0))
    if not 1e-9 < np.linalg.norm((x, y, z)) < 1e9:
        raise shape.error("the <normal> of <plane> has no length; use for example 0 0 1")
    width, depth, _ = _positive(shape, "size", (*extent, 1.0))
    return Geometry("plane", (width, depth, 0.0), (x, y, z))


def _positive(shape: Element, what: str, size: tuple[float, ...]) -> tuple[float, float, float]:
    if not all(value > 0.0 for value in size):
        raise shape.error(f"the {what} of <{shape.tag}> must be greater than zero")
    if not all(_SMALLEST <= value <= _LARGEST for value in size):
        raise shape.error(f"the {what} of <{shape.tag}> must be between {_SMALLEST:g} and {_LARGEST:g} metres")
    return size[0], size[1], size[2]


@lru_cache(maxsize=64)
def _cone(size: tuple[float, float, float]) -> TriangleMesh:
    """Return a cone along z of `size` (diameter, diameter, length) [m] with its base at -length/2 and its tip at
    length/2.
    """
    angles = np.linspace(0.0, 2.0 * np.pi, _SIDES, endpoint=False)
    low, high = -size[2] / 2.0, size[2] / 2.0
    ring = np.stack((np.cos(angles) * size[0] / 2.0, np.sin(angles) * size[0] / 2.0, np.full(_SIDES, low)), axis=1)
    vertices = np.concatenate((ring, [(0.0, 0.0, low), (0.0, 0.0, high)]))
    here = np.arange(_SIDES, dtype=np.int32)
    after = np.roll(here, -1)
    base, tip = np.full(_SIDES, _SIDES, dtype=np.int32), np.full(_SIDES, _SIDES + 1, dtype=np.int32)
    triangles = np.concatenate((np.stack((base, after, here), axis=1), np.stack((here, after, tip), axis=1)))
    return TriangleMesh(vertices.astype(np.float32), triangles, (vertices,))
