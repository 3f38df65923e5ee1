"""Reads glTF 2.0 (.gltf, .glb): the triangles of the scene, transformed by their nodes, and the base colours and
textures of their materials.

As in Gazebo the file's coordinates are taken as they are: its y axis is not turned up. Skins, animations, sparse and
compressed accessors are not read.

Source: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
Source: https://github.com/gazebosim/gz-common/blob/gz-common5/graphics/src/AssimpLoader.cc (coordinates)
"""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.errors import ResourceError
from gz_course.sim.gz.sim.sdf.description import Look
from gz_course.sim.gz.sim.sdf.mesh_parts import MOST_BYTES, Part, Triangles, Vertices
from gz_course.sim.gz.sim.sdf.textures import Pixels, decode

_MAGIC = b"glTF"
_JSON, _BIN = 0x4E4F534A, 0x004E4942
_DEEPEST = 100
_MOST_NODES = 100_000
_TRIANGLES = 4
_TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def read_gltf(path: Path, data: bytes, notes: list[str]) -> tuple[Vertices, list[Part]]:
    """Return the vertices and parts of a glTF file; `notes` takes sentences about what was left out.

    Raises ResourceError for a damaged file.
    """
    try:
        with np.errstate(all="ignore"):  # what is not finite is refused in the end
            return _File(path, data, notes).parts()
    except ResourceError:
        raise
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, OverflowError, RecursionError) as error:
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise ResourceError(f"{path}: the glTF file is damaged ({type(error).__name__}: {reason})") from None


class _File:
    def __init__(self, path: Path, data: bytes, notes: list[str]) -> None:
        self._path = path
        self._notes = notes
        self._binary = b""
        self._buffers: dict[int, bytes] = {}
        self._looks: dict[int, Look] = {}
        self._textures: dict[int, Pixels | None] = {}
        self._left = _MOST_NODES
        text = self._unpacked(data) if data[:4] == _MAGIC else data
        self._json: dict[str, Any] = json.loads(text)

    def _unpacked(self, data: bytes) -> bytes:
        """Return the JSON of a .glb file and keep its binary chunk."""
        text, at = b"{}", 12
        while at + 8 <= len(data):
            length, kind = (int.from_bytes(data[at + i : at + i + 4], "little") for i in (0, 4))
            chunk = data[at + 8 : at + 8 + length]
            if len(chunk) < length:
                raise ResourceError(f"{self._path}: the glTF file is cut off")
            if kind == _JSON:
                text = chunk
            elif kind == _BIN:
                self._binary = chunk
            at += 8 + length
        return text

    def parts(self) -> tuple[Vertices, list[Part]]:
        scenes = self._json.get("scenes", [])
        number = self._json.get("scene", 0)
        roots = scenes[number].get("nodes", []) if scenes else range(len(self._json.get("nodes", [])))
        vertices: list[Vertices] = [np.zeros((0, 3))]
        parts: list[Part] = []
        start = 0
        for root in roots:
            for corners, triangles, uv, names, look in self._walk(root, np.eye(4), "", 0):
                vertices.append(corners)
                parts.append(Part(names, triangles + start, uv, look))
                start += len(corners)
                if start > 50_000_000:
                    raise ResourceError(f"{self._path}: the nodes of the glTF file repeat too many meshes")
        return np.concatenate(vertices), parts

    def _walk(
        self, number: int, matrix: Vertices, name: str, depth: int
    ) -> Iterator[tuple[Vertices, Triangles, NDArray[np.float64] | None, tuple[str, ...], Look | None]]:
        """Yield the primitives below a node; a node without a name inherits that of its parent."""
        self._left -= 1
        if depth > _DEEPEST:
            raise ResourceError(f"{self._path}: the nodes of the glTF file are nested too deeply or in a circle")
        if self._left < 0:
            raise ResourceError(f"{self._path}: the glTF file shows its nodes more than {_MOST_NODES} times in all")
        node = self._json["nodes"][_index(number)]
        name = str(node.get("name") or name)
        below = matrix @ _matrix(node)
        if "mesh" in node:
            mesh = self._json["meshes"][_index(node["mesh"])]
            for primitive in mesh["primitives"]:
                if primitive.get("mode", _TRIANGLES) != _TRIANGLES:
                    self._notes.append(f"{self._path}: points, lines and strips of the mesh '{name}' are left out")
                    continue
                yield *self._primitive(primitive, below), (name, str(mesh.get("name", ""))), self._look(primitive)
        for child in node.get("children", []):
            yield from self._walk(child, below, name, depth + 1)

    def _primitive(
        self, primitive: dict[str, Any], matrix: Vertices
    ) -> tuple[Vertices, Triangles, NDArray[np.float64] | None]:
        attributes = primitive["attributes"]
        corners = self._accessor(attributes["POSITION"], 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
        if "indices" in primitive:
            found = self._accessor(primitive["indices"], 1)
            if found.dtype.kind != "u":
                raise ResourceError(f"{self._path}: indices of the glTF file are no whole numbers from 0")
            indices = found.reshape(-1).astype(np.int64)
        else:
            indices = np.arange(len(corners))
        triangles = indices[: len(indices) // 3 * 3].reshape(-1, 3)
        if len(triangles) and triangles.max() >= len(corners):
            raise ResourceError(f"{self._path}: a triangle of the glTF file names a vertex that is not there")
        if np.linalg.det(matrix[:3, :3]) < 0.0:  # a reflection reverses the winding order
            triangles = triangles[:, ::-1]
        uv = None
        if "TEXCOORD_0" in attributes:
            places = self._accessor(attributes["TEXCOORD_0"], 2)
            scale = 1.0 if places.dtype.kind == "f" else float(np.iinfo(places.dtype).max)
            uv = (places.astype(np.float64) / scale)[triangles]
            uv[..., 1] = 1.0 - uv[..., 1]
        return corners, triangles.astype(np.int32), uv

    def _accessor(self, number: int, width: int) -> NDArray[Any]:
        """Return the numbers of an accessor (n, width)."""
        accessor = self._json["accessors"][_index(number)]
        if "sparse" in accessor or "bufferView" not in accessor:
            raise ResourceError(f"{self._path}: sparse or compressed glTF is not read here; export it uncompressed")
        if _WIDTHS.get(accessor["type"]) != width:
            raise ResourceError(f"{self._path}: an accessor of the glTF file has the type {accessor['type']!r}")
        kind = np.dtype(_TYPES[accessor["componentType"]])
        view = self._json["bufferViews"][_index(accessor["bufferView"])]
        data, count = self._view(view), _index(accessor["count"])
        start, stride = _index(accessor.get("byteOffset", 0)), view.get("byteStride") or width * kind.itemsize
        if not width * kind.itemsize <= stride <= 252 and "byteStride" in view:
            raise ResourceError(f"{self._path}: a view of the glTF file has an impossible stride")
        if count and start + (count - 1) * stride + width * kind.itemsize > len(data):
            raise ResourceError(f"{self._path}: the glTF file is cut off: an accessor reaches beyond its buffer")
        found = np.ndarray((count, width), kind, data, start, (stride, kind.itemsize))
        return found.copy()

    def _view(self, view: dict[str, Any]) -> bytes:
        start = _index(view.get("byteOffset", 0))
        return self._buffer(_index(view["buffer"]))[start : start + _index(view["byteLength"])]

    def _buffer(self, number: int) -> bytes:
        if number not in self._buffers:
            uri = self._json["buffers"][number].get("uri")
            self._buffers[number] = self._binary if uri is None else self._opened(str(uri))
        return self._buffers[number]

    def _opened(self, uri: str) -> bytes:
        """Return the content of a data URI or of a file beside this one."""
        if uri.startswith("data:"):
            return base64.b64decode(uri.partition(",")[2])
        path = self._path.parent / unquote(uri)
        try:
            if path.stat().st_size > MOST_BYTES:
                raise ResourceError(f"{path} has more than {MOST_BYTES >> 20} MiB and is not read")
            return path.read_bytes()
        except OSError as error:
            raise ResourceError(f"{path} cannot be read ({error.strerror})") from None

    def _look(self, primitive: dict[str, Any]) -> Look | None:
        if "material" not in primitive:
            return None
        number = _index(primitive["material"])
        if number not in self._looks:
            material = self._json["materials"][number].get("pbrMetallicRoughness", {})
            red, green, blue, alpha = (min(1.0, max(0.0, float(v))) for v in material.get("baseColorFactor", [1] * 4))
            texture = material.get("baseColorTexture")
            pixels = None if texture is None else self._texture(_index(texture["index"]))
            self._looks[number] = Look((red, green, blue, alpha), pixels)
        return self._looks[number]

    def _texture(self, number: int) -> Pixels | None:
        source = _index(self._json["textures"][number]["source"])
        if source not in self._textures:
            image = self._json["images"][source]
            try:
                view = image.get("bufferView")
                named = view is None
                data = self._opened(str(image["uri"])) if named else self._view(self._json["bufferViews"][_index(view)])
                self._textures[source] = decode(data, f"{self._path} (image {source})")
            except ResourceError as error:
                self._notes.append(str(error))
                self._textures[source] = None
        return self._textures[source]


def _index(value: Any) -> int:
    """Return a number of the file that counts or numbers things; Python would take negative ones from the end."""
    if not isinstance(value, int) or value < 0:
        raise ValueError(f"{value!r} is no whole number from 0")
    return value


def _matrix(node: dict[str, Any]) -> Vertices:
    """Return the transform of a node: its matrix, or translation, rotation (xyzw) and scale."""
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    made = np.eye(4)
    x, y, z, w = (float(value) for value in node.get("rotation", (0, 0, 0, 1)))
    made[:3, :3] = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    made[:3, :3] *= np.array(node.get("scale", (1, 1, 1)), np.float64)
    made[:3, 3] = node.get("translation", (0, 0, 0))
    return made
