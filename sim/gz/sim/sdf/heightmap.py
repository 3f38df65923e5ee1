"""Reads `<heightmap>` of a `<geometry>`: the grey values of an image as heights over a rectangle.

`gz.sim.sdf.geometry` calls it; `gz.sim.physics.geoms` makes a MuJoCo height field of the result. Black has the height
zero and the brightest pixel of the image the z of `<size>`; a negative z inverts the heights. The first row of the
image lies at +y.

Source: gz-common 5, https://github.com/gazebosim/gz-common/blob/gz-common5/geospatial/src/ImageHeightmap.cc
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.errors import Diagnostics, ResourceError
from gz_course.sim.gz.sim.sdf.description import Geometry, TriangleMesh
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.resources import Resources


def read_heightmap(
    shape: Element, owner: Element, moving: bool, diagnostics: Diagnostics, resources: Resources
) -> Geometry | None:
    """Return the terrain with heights from zero, without the offset of `<pos>`, or None after a warning."""
    left_out = f"so <{owner.tag}> '{owner.name}' is left out"
    uri = shape.text_of("uri")
    if moving:
        diagnostics.warn(shape.where, f"a heightmap cannot move, {left_out}; make its model static")
        return None
    size = shape.vector("size", (1.0, 1.0, 1.0))
    if not (0.0 < size[0] < 1e6 and 0.0 < size[1] < 1e6 and 0.0 < abs(size[2]) < 1e6):
        raise shape.error(f"the <size> of <heightmap> must be greater than zero, got '{shape.text_of('size')}'")
    if not uri:
        diagnostics.warn(shape.where, f"<heightmap> has no <uri>, {left_out}")
        return None
    try:
        path = resources.find_file(uri, shape.folder)
        heights, mesh = _terrain(resources, path, resources.stamp(path), (size[0], size[1], size[2]))
    except (ResourceError, OSError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        diagnostics.warn((shape.find("uri") or shape).where, f"{reason}, {left_out}")
        return None
    return Geometry("heightmap", (size[0], size[1], abs(size[2])), mesh=mesh, heights=heights)


@lru_cache(maxsize=8)
def _terrain(
    resources: Resources, path: Path, _stamp: tuple[int, ...], size: tuple[float, float, float]
) -> tuple[NDArray[np.float64], TriangleMesh]:
    """Return the heights (rows, columns) [m] and their surface.

    `_stamp` changes with the content of the file, so that the cache does not return an old version.
    """
    pixels = resources.read_image(path).astype(np.float64)
    brightest = float(pixels.max())
    heights = pixels[::-1] / brightest if brightest > 0.0 else pixels
    if size[2] < 0.0:
        heights = 1.0 - heights
    heights = heights * abs(size[2])
    return heights, _surface(heights, size)


def _surface(heights: NDArray[np.float64], size: tuple[float, ...]) -> TriangleMesh:
    rows, columns = heights.shape
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, columns) * size[0], np.linspace(-0.5, 0.5, rows) * size[1])
    vertices = np.stack((x, y, heights), axis=-1).reshape(-1, 3).astype(np.float32)
    corner = np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
    triangles = np.stack((a, b, c, a, c, d), axis=-1).reshape(-1, 3)
    return TriangleMesh(vertices, triangles)
