"""Reads `<polyline>`: outlines in the x-y plane, extruded along z from 0 to `<height>`.

Several polylines in one geometry make one shape; an outline inside another is a hole (even-odd rule, as in Gazebo). The
area is cut into triangles, which are joined to convex polygons; their prisms collide, because MuJoCo's collision meshes
are convex.

Source: SDFormat, element `<polyline>`, http://sdformat.org/spec
"""

from __future__ import annotations

from collections.abc import Sequence

import mapbox_earcut
import numpy as np

from gz_course.sim.gz.sim.sdf.description import Geometry, TriangleMesh
from gz_course.sim.gz.sim.sdf.element import Element

Point = tuple[float, float]
_MOST_POINTS = 1000
_LARGEST = 1e6  # [m]


def read_polyline(shapes: Sequence[Element]) -> Geometry | None:
    """Return the prism of the `<polyline>` elements of one geometry, or None if they intersect themselves.

    Raises SdfError for outlines without area.
    """
    outlines: list[list[Point]] = []
    height = shapes[0].number("height", 1.0)
    if not 0.0 < height < _LARGEST:
        raise shapes[0].error(f"the <height> of <polyline> must be greater than zero, got {height:g}")
    for shape in shapes:
        outline: list[Point] = []
        for element in shape.all("point"):
            x, y = element.floats(2)
            if not (abs(x) < _LARGEST and abs(y) < _LARGEST):
                raise element.error(f"<point> must be finite and below {_LARGEST:g} m, got '{element.text}'")
            if not outline or (x, y) != outline[-1]:
                outline.append((x, y))
        if len(outline) > 1 and outline[0] == outline[-1]:
            outline.pop()
        if len(outline) < 3 or abs(_area(outline)) < 1e-12:
            raise shape.error("<polyline> needs at least three <point>s that enclose an area")
        outlines.append(outline)
    if sum(map(len, outlines)) > _MOST_POINTS:
        raise shapes[0].error(f"<polyline> has more than {_MOST_POINTS} points; use a mesh")
    polygons: list[list[Point]] = []
    nested = _nested(outlines)
    for outline, holes in nested:
        cut = _convex_parts([outline, *holes])
        whole = _area(outline) + sum(map(_area, holes))
        if abs(sum(map(_area, cut)) - whole) > 1e-6 * _area(outline):
            return None
        polygons.extend(cut)
    mesh = _extruded([ring for outline, holes in nested for ring in (outline, *holes)], polygons, height)
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    return Geometry("polyline", (float(high[0] - low[0]), float(high[1] - low[1]), height), mesh=mesh)


def _area(outline: Sequence[Point]) -> float:
    """Return the signed area [m^2], positive when the points turn left.

    Source: shoelace formula, https://en.wikipedia.org/wiki/Shoelace_formula
    """
    return 0.5 * sum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in zip(outline, [*outline[1:], outline[0]], strict=True))


def _inside(point: Point, outline: Sequence[Point]) -> bool:
    x, y = point
    odd = False
    for (x1, y1), (x2, y2) in zip(outline, [*outline[1:], outline[0]], strict=True):
        if (y1 > y) != (y2 > y) and x < x1 + (y - y1) / (y2 - y1) * (x2 - x1):
            odd = not odd
    return odd


def _nested(outlines: list[list[Point]]) -> list[tuple[list[Point], list[list[Point]]]]:
    """Return each outline that encloses area (counter-clockwise) with its holes (clockwise)."""
    depth = [sum(_inside(one[0], other) for other in outlines if other is not one) for one in outlines]
    found = []
    for outline, level in zip(outlines, depth, strict=True):
        if level % 2:
            continue
        holes = [
            hole if _area(hole) < 0.0 else hole[::-1]
            for hole, below in zip(outlines, depth, strict=True)
            if below == level + 1 and _inside(hole[0], outline)
        ]
        found.append((outline if _area(outline) > 0.0 else outline[::-1], holes))
    return found


def _side(a: Point, b: Point, c: Point) -> float:
    """Return twice the signed area of a triangle, positive if it is counter-clockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _convex_parts(rings: Sequence[Sequence[Point]]) -> list[list[Point]]:
    """Cut an outline with holes (the other rings) into convex polygons, all counter-clockwise.

    Source: ear clipping of mapbox-earcut, https://github.com/mapbox/earcut
    """
    points = [point for ring in rings for point in ring]
    ends = np.cumsum([len(ring) for ring in rings], dtype=np.uint32)
    ears = mapbox_earcut.triangulate_float64(np.array(points, dtype=np.float64), ends).reshape(-1, 3).tolist()
    return [[points[k] for k in part] for part in _joined(ears, points)]


def _joined(parts: list[list[int]], polygon: list[Point]) -> list[list[int]]:
    """Join neighbours across their common edge while the result is convex.

    Source: S. Hertel, K. Mehlhorn, Fast triangulation of the plane with respect to simple polygons, 1985
    """
    owner = {(part[k - 1], part[k]): index for index, part in enumerate(parts) for k in range(len(part))}
    alive: dict[int, list[int]] = dict(enumerate(parts))
    for edge in list(owner):
        one, other = owner[edge], owner.get((edge[1], edge[0]), -1)
        if other < 0 or one == other:
            continue
        a, b = alive[one], alive[other]
        i, j = a.index(edge[1]), b.index(edge[0])
        # Go around polygon a from the end of the edge to its start, then around b.
        whole = a[i:] + a[:i] + (b[j:] + b[:j])[1:-1]
        if len(set(whole)) < len(whole):
            continue
        corners = [polygon[k] for k in whole]
        if all(_side(corners[k - 2], corners[k - 1], corners[k]) >= 0.0 for k in range(len(corners))):
            alive[one] = whole
            del alive[other]
            owner.update({key: one for key, index in owner.items() if index == other})
    return list(alive.values())


def _extruded(rings: list[list[Point]], polygons: list[list[Point]], height: float) -> TriangleMesh:
    """Return the walls of all rings (holes clockwise), floor and lid of the polygons, with outward normals."""
    vertices: list[tuple[float, float, float]] = []
    triangles: list[tuple[int, int, int]] = []

    def add(*corners: tuple[float, float, float]) -> None:
        base = len(vertices)
        vertices.extend(corners)
        triangles.extend((base, base + k, base + k + 1) for k in range(1, len(corners) - 1))

    for ring in rings:
        for (x1, y1), (x2, y2) in zip(ring, [*ring[1:], ring[0]], strict=True):
            add((x1, y1, 0.0), (x2, y2, 0.0), (x2, y2, height), (x1, y1, height))
    for polygon in polygons:
        add(*((x, y, height) for x, y in polygon))
        add(*((x, y, 0.0) for x, y in reversed(polygon)))
    pieces = tuple(np.array([(x, y, z) for z in (0.0, height) for x, y in polygon]) for polygon in polygons)
    return TriangleMesh(np.array(vertices, dtype=np.float32), np.array(triangles, dtype=np.int32), pieces)
