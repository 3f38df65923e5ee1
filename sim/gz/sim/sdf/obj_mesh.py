"""Reads Wavefront OBJ and the colours and textures of its MTL file.

Of OBJ: `v`, `vt`, `f` (any number of corners, negative indices), `o`, `g`, `usemtl` and `mtllib`; of MTL: `newmtl`,
`Kd`, `d`, `Tr` and `map_Kd`; the rest is ignored. A colour or texture that cannot be read leaves the part plain.

Source: https://paulbourke.net/dataformats/obj/
Source: https://paulbourke.net/dataformats/mtl/
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from gz_course.sim.gz.sim.errors import ResourceError
from gz_course.sim.gz.sim.sdf.description import Look
from gz_course.sim.gz.sim.sdf.mesh_parts import Part, Vertices, fan, numbers, rows_of
from gz_course.sim.gz.sim.sdf.textures import Pixels, read_texture

_LONGEST_MTL = 4 << 20  # [byte]
_MOST_MATERIALS = 1000


def read_obj(path: Path, data: bytes, notes: list[str]) -> tuple[Vertices, list[Part]]:
    """Return the vertices and parts of an OBJ file; `notes` takes sentences about what was left out.

    Raises ResourceError with the line for a damaged file.
    """
    vertices: list[tuple[float, ...]] = []
    places: list[tuple[float, float]] = []
    parts: list[Part] = [Part((), [])]
    materials: dict[str, Look] = {}
    thing, material = "", ""
    groups: tuple[str, ...] = ()
    number = first = 0
    held = ""
    for number, raw in enumerate(data.decode("utf-8", "replace").split("\n"), 1):
        first = first or number
        if raw.rstrip("\r").endswith("\\"):
            held += raw.rstrip("\r")[:-1] + " "
            continue
        text = (held + raw).split("#", 1)[0]
        words = text.split()
        held, line, first = "", first, 0
        if not words:
            continue
        word = words[0]
        if word == "v":
            vertices.append(numbers(path, line, words[1:4]))
        elif word == "vt":
            places.append(_place(words[1:3]))
        elif word == "f":
            _add_face(path, line, words[1:], len(vertices), places, parts[-1])
        elif word == "mtllib" and len(words) > 1:
            materials |= _read_mtl(path.parent / text.split(None, 1)[1].strip(), notes)
        elif word in ("o", "g", "usemtl"):
            if word == "o":
                thing = " ".join(words[1:])
            elif word == "g":
                groups = tuple(words[1:])
            else:
                material = " ".join(words[1:])
            names = tuple(dict.fromkeys((thing, *groups, " ".join(groups))))
            parts.append(Part(names, [], None, materials.get(material)))
    if held:
        raise ResourceError(f"{path}:{number}: the OBJ file is cut off: its last line asks for another one")
    return rows_of(vertices), parts


def _place(words: list[str]) -> tuple[float, float]:
    try:
        u, v = float(words[0]), float(words[1]) if len(words) > 1 else 0.0
    except (ValueError, IndexError):
        return 0.0, 0.0
    return (u, v) if math.isfinite(u) and math.isfinite(v) else (0.0, 0.0)


def _add_face(
    path: Path, line: int, words: list[str], count: int, places: list[tuple[float, float]], part: Part
) -> None:
    """Add one face, whose corners are written `a`, `a/b`, `a//c` or `a/b/c`."""
    if len(words) < 3:
        raise ResourceError(f"{path}:{line}: a face needs at least three corners, got {len(words)}")
    corners: list[int] = []
    uv: list[tuple[float, float]] = []
    for word in words:
        vertex, _, rest = word.partition("/")
        try:
            index = int(vertex)
        except ValueError:
            raise ResourceError(f"{path}:{line}: '{word[:20]}' is no corner of a face, expected an index") from None
        index = index - 1 if index > 0 else count + index if index < 0 else -1
        if not 0 <= index < count:
            raise ResourceError(f"{path}:{line}: a face names vertex {word[:20]}, but {count} vertices came before it")
        corners.append(index)
        if rest and places:
            uv.append(_at(rest.partition("/")[0], places))
    before = len(part.triangles)
    part.add(fan(corners))
    if len(uv) == len(corners) or part.uv is not None:
        if part.uv is None:
            part.uv = [((0.0, 0.0),) * 3] * before
        assert isinstance(part.uv, list)
        if len(uv) < len(corners):
            uv = [(0.0, 0.0)] * len(corners)
        part.uv.extend((uv[a], uv[b], uv[c]) for a, b, c in fan(range(len(corners))))


def _at(word: str, places: list[tuple[float, float]]) -> tuple[float, float]:
    try:
        index = int(word)
    except ValueError:
        return 0.0, 0.0
    index = index - 1 if index > 0 else len(places) + index
    return places[index] if 0 <= index < len(places) else (0.0, 0.0)


@dataclass(eq=False)
class _Material:
    colour: tuple[float, float, float] = (0.7, 0.7, 0.7)
    alpha: float = 1.0
    texture: Pixels | None = None

    def look(self) -> Look:
        # Some exporters write black beside a texture; the texture would not be seen.
        colour = (1.0, 1.0, 1.0) if self.texture is not None and not any(self.colour) else self.colour
        return Look((*colour, self.alpha), self.texture)


def _read_mtl(path: Path, notes: list[str]) -> dict[str, Look]:
    """Return the materials of an MTL file by their names; a file that cannot be read has none, with a note."""
    try:
        if path.stat().st_size > _LONGEST_MTL:
            notes.append(f"{path}: the material file is larger than {_LONGEST_MTL >> 20} MiB and is not read")
            return {}
        text = path.read_bytes().decode("utf-8", "replace")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        notes.append(f"{path}: the material file cannot be read ({reason}), so parts of the mesh are grey")
        return {}
    found: dict[str, _Material] = {}
    material = _Material()
    for raw in text.splitlines():
        words = raw.split("#", 1)[0].split()
        if not words or len(found) > _MOST_MATERIALS:
            continue
        try:
            if words[0] == "newmtl":
                material = found.setdefault(" ".join(words[1:]), _Material())
            elif words[0] == "Kd":
                red, green, blue = (min(1.0, max(0.0, float(word))) for word in words[1:4])
                material.colour = red, green, blue
            elif words[0] in ("d", "Tr"):
                value = min(1.0, max(0.0, float(words[-1])))
                material.alpha = value if words[0] == "d" else 1.0 - value
            elif words[0] == "map_Kd" and len(words) > 1:
                # Options stand before the name, which may contain spaces.
                name = raw.split("#", 1)[0].split(None, 1)[1].strip()
                name = name if not name.startswith("-") else words[-1]
                material.texture = read_texture(path.parent / name.replace("\\", "/"))
        except (ValueError, ResourceError) as error:
            notes.append(f"{path}: {error}" if isinstance(error, ValueError) else str(error))
    return {name: material.look() for name, material in found.items()}
