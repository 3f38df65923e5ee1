"""The models, meshes and images that a description names, in memory under the hash of their content.

`gz.sim.sdf.packing` makes assets from files. A reader that is given `Assets` opens no files, expands no xacro and finds
no other models. An address is `asset:SHA256` with a suffix for the format:

    .sdf    the text of a model, light or world that an `<include>` brings (UTF-8)
    .mesh   uint32 vertices, triangles, textured (0 or 1), looks; float64 (vertices, 3) [m]; int32 (triangles, 3)
            indices; if textured float32 (triangles, 3, 2); if there are looks int32 (triangles,) and for each look
            float32 rgba and an image as in .rgb, of 0 rows and columns for none; little-endian
    .grey   uint32 rows, uint32 columns, uint8 (rows, columns): the heights of a `<heightmap>`
    .rgb    uint32 rows, uint32 columns, uint8 (rows, columns, 3): a texture
"""

from __future__ import annotations

import hashlib
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.errors import ResourceError
from gz_course.sim.gz.sim.sdf.description import Look
from gz_course.sim.gz.sim.sdf.grey_image import MOST_PIXELS
from gz_course.sim.gz.sim.sdf.meshes import Mesh
from gz_course.sim.gz.sim.sdf.textures import LARGEST, Pixels

LEFT_OUT = "left out: "
"""The prefix of a `<uri>` that says why a file cannot be used; readers leave such an element out with a warning."""

MOST_BYTES = 64 << 20  # [byte] of all assets together
MOST_ASSETS = 500
LONGEST_TEXT = 8 << 20  # [byte]
MOST_OPENED = 256 << 20  # [byte] of all included texts; a text counts once for each include
ADDRESS = re.compile(r"asset:([0-9a-f]{64})\.(sdf|mesh|grey|rgb)", re.ASCII)
_LARGEST = 1e9  # [m]


def address(data: bytes, kind: str) -> str:
    """Return the address of the content `data`; `kind` is its suffix."""
    return f"asset:{hashlib.sha256(data).hexdigest()}.{kind}"


def mesh_bytes(mesh: Mesh) -> bytes:
    """Return a mesh as the bytes of an asset."""
    counts = len(mesh.vertices), len(mesh.triangles), mesh.uv is not None, len(mesh.looks)
    parts = [np.array(counts, dtype="<u4"), mesh.vertices.astype("<f8"), mesh.triangles.astype("<i4")]
    if mesh.uv is not None:
        parts.append(mesh.uv.astype("<f4"))
    if mesh.look is not None:
        parts.append(mesh.look.astype("<i4"))
    data = b"".join(part.tobytes() for part in parts)
    none = np.zeros((0, 0, 3), np.uint8)
    for look in mesh.looks:
        texture = none if look.texture is None else look.texture
        data += np.array(look.rgba, dtype="<f4").tobytes() + image_bytes(texture)
    return data


def image_bytes(image: NDArray[np.uint8]) -> bytes:
    """Return an image of one channel (rows, columns) or of colours (rows, columns, 3) as the bytes of an asset."""
    return np.array(image.shape[:2], dtype="<u4").tobytes() + image.tobytes()


class Assets:
    """A collection of assets, for use as the resources of a reader."""

    opens_files = False

    def __init__(self) -> None:
        self._held: dict[str, bytes] = {}
        self._bytes = self._opened = 0

    def add(self, name: str, data: bytes) -> None:
        """Add an asset. Raises `ResourceError` if its address is not that of its content, or if there are too many
        assets.
        """
        match = ADDRESS.fullmatch(name)
        if match is None or name != address(data, match[2]):
            raise ResourceError("what was handed over is not what its address says")
        if name in self._held:
            return
        if match[2] == "sdf" and len(data) > LONGEST_TEXT:
            raise ResourceError(f"a description of {len(data) >> 20} MiB is too large; {LONGEST_TEXT >> 20} are read")
        if len(self._held) >= MOST_ASSETS or self._bytes + len(data) > MOST_BYTES:
            raise ResourceError(
                f"the world names more than {MOST_ASSETS} files or {MOST_BYTES >> 20} MiB of models, meshes and images"
            )
        self._held[name] = data
        self._bytes += len(data)

    def text(self, name: str) -> str:
        """Return the text at an address. Raises `ResourceError` if it does not exist."""
        data = self._data(Path(name), "sdf")
        self._opened += len(data)
        if self._opened > MOST_OPENED:
            raise ResourceError(f"the world includes more than {MOST_OPENED >> 20} MiB of models")
        return data.decode("utf-8", "replace")

    def find_model(self, uri: str, relative_to: Path | None) -> Path:
        """Return the path for the address of a text."""
        return self._found(uri, "sdf")

    def find_file(self, uri: str, relative_to: Path | None) -> Path:
        """Return the path for the address of a mesh or image."""
        return self._found(uri, "mesh", "grey", "rgb")

    def real(self, path: Path) -> Path:
        """Return `path`, because every asset has one path only."""
        return path

    def stamp(self, path: Path) -> tuple[int, ...]:
        """Return an empty tuple, because the content at an address never changes."""
        return ()

    def read_text(self, path: Path) -> str:
        """Return the text at an address."""
        return self.text(str(path))

    def read_mesh(self, path: Path, submesh: str, center: bool) -> Mesh:
        """Return a mesh; submesh and centring were applied when it was packed."""
        taken = _Taken(self._data(path, "mesh"), "a mesh")
        count, faces, textured, many = taken.numbers("<u4", (4,)).tolist()
        vertices = taken.numbers("<f8", (count, 3))
        triangles = taken.numbers("<i4", (faces, 3))
        uv = taken.numbers("<f4", (faces, 3, 2)) if textured else None
        look = taken.numbers("<i4", (faces,)) if many else None
        looks = tuple(taken.look() for _ in range(min(many, faces)))
        taken.end()
        if not faces or many > faces or (look is not None and not (look.min() >= 0 and look.max() < many)):
            raise ResourceError("a mesh was handed over in pieces that do not fit")
        if not np.all(np.abs(vertices) <= _LARGEST) or not (uv is None or np.all(np.abs(uv) <= _LARGEST)):
            raise ResourceError(f"a mesh has a vertex that is not finite or is farther than {_LARGEST:g} away")
        if triangles.min() < 0 or triangles.max() >= count:
            raise ResourceError("a triangle of a mesh names a vertex that is not there")
        return Mesh(vertices, triangles, uv, looks, look)

    def read_texture(self, path: Path) -> Pixels:
        """Return the colours of a texture."""
        taken = _Taken(self._data(path, "rgb"), "an image")
        pixels = taken.image()
        taken.end()
        if pixels is None:
            raise ResourceError("an image was handed over in pieces that do not fit")
        return pixels

    def read_image(self, path: Path) -> NDArray[np.uint8]:
        """Return an image of one channel."""
        data = self._data(path, "grey")
        rows, columns = (int(number) for number in np.frombuffer(data[:8].ljust(8, b"\0"), "<u4"))
        if min(rows, columns) < 2 or rows * columns > MOST_PIXELS or len(data) != 8 + rows * columns:
            raise ResourceError("an image was handed over in pieces that do not fit")
        return np.frombuffer(data, np.uint8, rows * columns, 8).reshape(rows, columns)

    def _found(self, uri: str, *kinds: str) -> Path:
        match = ADDRESS.fullmatch(uri)
        if match is None or match[2] not in kinds or uri not in self._held:
            if uri.startswith(LEFT_OUT):
                raise ResourceError(uri.removeprefix(LEFT_OUT)[:300])
            raise ResourceError(f"'{uri[:200]}' is not among what was handed over")
        return Path(uri)

    def _data(self, path: Path, kind: str) -> bytes:
        return self._held[str(self._found(str(path), kind))]


class _Taken:
    """The bytes of an asset, taken piece by piece; raises ResourceError if they do not fit."""

    def __init__(self, data: bytes, what: str) -> None:
        self._data = data
        self._what = what
        self._at = 0

    def numbers(self, kind: str, shape: tuple[int, ...]) -> NDArray[Any]:
        count = math.prod(shape)
        size = count * np.dtype(kind).itemsize
        if self._at + size > len(self._data):
            raise ResourceError(f"{self._what} was handed over in pieces that do not fit")
        found = np.frombuffer(self._data, kind, count, self._at).reshape(shape)
        self._at += size
        return found

    def image(self) -> Pixels | None:
        """Return an image; None if it has no pixels."""
        rows, columns = self.numbers("<u4", (2,)).tolist()
        if max(rows, columns) > LARGEST or (rows == 0) != (columns == 0):
            raise ResourceError(f"an image of {columns} x {rows} pixels was handed over; {LARGEST} are possible")
        return self.numbers("|u1", (rows, columns, 3)) if rows else None

    def look(self) -> Look:
        red, green, blue, alpha = np.clip(np.nan_to_num(self.numbers("<f4", (4,))), 0.0, 1.0).tolist()
        return Look((red, green, blue, alpha), self.image())

    def end(self) -> None:
        if self._at != len(self._data):
            raise ResourceError(f"{self._what} was handed over in pieces that do not fit")
