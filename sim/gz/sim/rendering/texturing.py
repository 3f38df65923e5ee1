"""The textures of visuals as cameras see them: which point of a surface shows which point of an image.

A box has its texture on each face, a plane once over its whole size; round shapes have it once round them, upright. A
mesh has the places of its file, interpolated in the triangle that was hit. Images are halved again and again, and each
pixel looks into the one whose texels are about as large as itself.

Source: https://en.wikipedia.org/wiki/UV_mapping
Source: https://en.wikipedia.org/wiki/Mipmap
"""

from __future__ import annotations

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.rendering.facing import Seen
from gz_course.sim.gz.sim.rendering.tile_caster import View
from gz_course.sim.gz.sim.sdf.textures import Pixels, fingerprint

Values = NDArray[np.float32]
_KIND = mujoco.mjtGeom
_FLATTEST = 0.15
"""The smallest cosine of a surface to the line of sight that the size of a pixel on it takes into account."""


class Texture:
    """One image, and its reductions by 2, 4, 8, ..."""

    def __init__(self, pixels: Pixels) -> None:
        self.area = float(pixels.shape[0] * pixels.shape[1])
        self._levels = [_Level(pixels)]
        while min(pixels.shape[:2]) > 1:
            rows, columns = pixels.shape[0] // 2 * 2, pixels.shape[1] // 2 * 2
            four = pixels[:rows, :columns].reshape(rows // 2, 2, columns // 2, 2, 3).sum(axis=(1, 3), dtype=np.uint16)
            pixels = ((four + 2) // 4).astype(np.uint8)
            self._levels.append(_Level(pixels))

    def colours(self, u: Values, v: Values, texels: Values) -> Values:
        """Return the colours (3, n) at places (n,), for pixels that are `texels` wide."""
        result = np.empty((3, len(u)), np.float32)
        chosen = np.rint(np.log2(np.maximum(texels, np.float32(1.0)))).astype(np.intp)
        np.minimum(chosen, len(self._levels) - 1, out=chosen)
        for number in np.unique(chosen).tolist():
            of = np.flatnonzero(chosen == number)
            result[:, of] = self._levels[number].colours(u[of], v[of])
        return result


class _Level:
    """One image, its channels one after another."""

    def __init__(self, pixels: Pixels) -> None:
        self._rows, self._columns = pixels.shape[:2]
        self._channels = np.ascontiguousarray(pixels.reshape(-1, 3).T)

    def colours(self, u: Values, v: Values) -> Values:
        """Return the colours (3, n) between the four texels round each place (n,); the image repeats itself."""
        x = (u - np.floor(u)) * np.float32(self._columns) - np.float32(0.5)
        y = (v - np.floor(v)) * np.float32(self._rows) - np.float32(0.5)
        left, top = np.floor(x), np.floor(y)
        across, down = x - left, y - top
        column, row = left.astype(np.int32) % self._columns, top.astype(np.int32) % self._rows
        right, below = (column + 1) % self._columns, (row + 1) % self._rows * self._columns
        row *= self._columns
        corners = row + column, row + right, below + column, below + right
        shares = (1 - across) * (1 - down), across * (1 - down), (1 - across) * down, across * down
        result = np.zeros((3, len(u)), np.float32)
        for corner, share in zip(corners, shares, strict=True):
            share *= np.float32(1.0 / 255.0)
            for channel in range(3):
                result[channel] += np.take(self._channels[channel], corner) * share
        return result


class Textures:
    """The textures of the geoms of one world, by geom id."""

    def __init__(self, model: mujoco.MjModel, images: dict[int, Pixels]) -> None:
        made: dict[bytes, Texture] = {}
        self._model = model
        self._of: dict[int, Texture] = {}
        for geom, image in images.items():
            key = fingerprint(image)
            self._of[geom] = made[key] = made.get(key) or Texture(image)
        self._density = {geom: math.sqrt(each.area / _area(model, geom)) for geom, each in self._of.items()}
        """Texels for each metre."""

    def colour(self, view: View, seen: Seen, result: Values) -> None:
        """Multiply colours (3, tiles, pixels) by the textures of what is seen."""
        if not self._of:
            return
        shape = (seen.code >> 3).ravel()
        flat = seen.points.reshape(3, -1), seen.normal.reshape(3, -1)
        for index in np.unique(shape).tolist():
            geom = int(view.surfaces.ids[index]) if index >= 0 else -1
            if geom not in self._of:
                continue
            places = np.flatnonzero(shape == index)
            points, facing = (np.take(each, places, axis=1) for each in flat)
            surfaces = view.surfaces
            local = surfaces.inverse[index] @ (points - surfaces.position[index, :, None].astype(np.float32))
            distance = np.sqrt(np.einsum("in,in->n", points, points))
            cosine = np.abs(np.einsum("in,in->n", facing, points)) / np.maximum(distance, 1e-6)
            width = distance * view.tiles.pixel / np.sqrt(np.maximum(cosine, _FLATTEST))
            if self._model.geom_type[geom] == _KIND.mjGEOM_MESH:
                u, v = _in_mesh(self._model, geom, local.T.astype(np.float64))
            else:
                normal = surfaces.inverse[index] @ facing
                u, v = _on_shape(int(self._model.geom_type[geom]), surfaces.size[index], local, normal)
            texels = (width * self._density[geom]).astype(np.float32)
            colours = self._of[geom].colours(u.astype(np.float32), v.astype(np.float32), texels)
            for channel in range(3):
                result[channel].reshape(-1)[places] *= colours[channel]


def _area(model: mujoco.MjModel, geom: int) -> float:
    """Return the size [m^2] of the surface that shows the texture once."""
    kind = int(model.geom_type[geom])
    x, y, z = (float(value) for value in model.geom_size[geom])
    if kind == _KIND.mjGEOM_PLANE:
        return 4.0 * x * y
    if kind == _KIND.mjGEOM_BOX:
        return 4.0 * (x * y + y * z + z * x) / 3.0
    if kind == _KIND.mjGEOM_CYLINDER:
        return 4.0 * math.pi * x * y
    if kind != _KIND.mjGEOM_MESH:
        return 4.0 * math.pi * x * x
    corners, places = _triangles(model, geom)
    surface = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()
    first, second = places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]
    shown = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]).sum()
    return float(surface / max(shown, 1e-9)) or 1.0


def _on_shape(kind: int, size: Values, point: Values, normal: Values) -> tuple[Values, Values]:
    """Return the places (n,) in a texture of points (3, n) of a simple shape, both in its own frame."""
    half = np.float32(0.5)
    if kind == _KIND.mjGEOM_PLANE:
        return point[0] / (2 * size[0]) + half, half - point[1] / (2 * size[1])
    if kind == _KIND.mjGEOM_BOX:
        x, y, z = (point / (2 * size[:, None])).astype(np.float32)
        axis = np.abs(normal).argmax(axis=0)
        sign = np.sign(np.take_along_axis(normal, axis[None], axis=0)[0])
        u = np.where(axis == 0, y * sign, np.where(axis == 1, -x * sign, y * -sign))
        return u + half, half - np.where(axis == 2, x, z)
    turn = np.arctan2(point[1], point[0]) / np.float32(2.0 * math.pi) + half
    if kind == _KIND.mjGEOM_CYLINDER:
        cap = np.abs(normal[2]) > 0.5
        u = np.where(cap, point[0] / (2 * size[0]) + half, turn)
        return u, half - np.where(cap, point[1] / (2 * size[0]), point[2] / (2 * size[1]))
    height = normal[2] / np.maximum(np.sqrt(np.einsum("in,in->n", normal, normal)), np.float32(1e-6))
    return turn, half - np.arcsin(np.clip(height, -1.0, 1.0)) / np.float32(math.pi)


def _triangles(model: mujoco.MjModel, geom: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the corners (m, 3, 3) [m] of a mesh and their places in a texture (m, 3, 2)."""
    mesh = int(model.geom_dataid[geom])
    first, count = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    corners = model.mesh_vert[int(model.mesh_vertadr[mesh]) + model.mesh_face[first : first + count]]
    start = int(model.mesh_texcoordadr[mesh])
    if start < 0:
        return corners.astype(np.float64), np.zeros((count, 3, 2))
    places = model.mesh_texcoord[start + model.mesh_facetexcoord[first : first + count]]
    return corners.astype(np.float64), places.astype(np.float64)


def _in_mesh(model: mujoco.MjModel, geom: int, points: NDArray[np.float64]) -> tuple[Values, Values]:
    """Return the places (n,) in the texture of points (n, 3) of the surface of a mesh, in the frame of its geom."""
    mesh = int(model.geom_dataid[geom])
    corners, places = _triangles(model, geom)
    point, triangle = _close(model, mesh, points)
    a, b, c = corners[triangle].swapaxes(0, 1)
    p = points[point]
    normal = np.cross(b - a, c - a)
    square = np.maximum(np.einsum("ki,ki->k", normal, normal), 1e-30)
    second = np.einsum("ki,ki->k", np.cross(p - a, c - a), normal) / square
    third = np.einsum("ki,ki->k", np.cross(b - a, p - a), normal) / square
    first = 1.0 - second - third
    outside = np.maximum(0.0, -np.minimum(np.minimum(first, second), third)) * np.sqrt(np.sqrt(square))
    wrong = outside + np.abs(np.einsum("ki,ki->k", p - a, normal)) / np.sqrt(square)
    order = np.lexsort((wrong, point))
    chosen, where = np.unique(point[order], return_index=True)
    best = order[where]
    weights = np.stack((first, second, third), axis=1)[best]
    found = np.zeros((len(points), 2))
    found[chosen] = np.einsum("kc,kcd->kd", np.clip(weights, 0.0, 1.0), places[triangle[best]])
    return found[:, 0].astype(np.float32), found[:, 1].astype(np.float32)


def _close(model: mujoco.MjModel, mesh: int, points: NDArray[np.float64]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return pairs of a point and a triangle whose bounding box in MuJoCo's tree of the mesh is next to it."""
    start, count = int(model.mesh_bvhadr[mesh]), int(model.mesh_bvhnum[mesh])
    box = model.bvh_aabb[start : start + count]
    child, leaf = model.bvh_child[start : start + count], model.bvh_nodeid[start : start + count]
    slack = 1e-5 + 1e-3 * float(np.max(box[0, 3:]))
    point, node = np.arange(len(points)), np.zeros(len(points), np.intp)
    found: list[tuple[NDArray[np.intp], NDArray[np.intp]]] = []
    while len(point):
        near = (np.abs(points[point] - box[node, :3]) <= box[node, 3:] + slack).all(axis=1)
        point, node = point[near], node[near]
        ends = leaf[node] >= 0
        found.append((point[ends], leaf[node[ends]].astype(np.intp)))
        point, node = point[~ends], node[~ends]
        below = child[node].astype(np.intp)
        point, node = np.repeat(point, 2), below.ravel()
        exists = node >= 0
        point, node = point[exists], node[exists]
    return np.concatenate([each[0] for each in found]), np.concatenate([each[1] for each in found])
