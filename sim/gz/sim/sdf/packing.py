"""Packs a description together with the files it names, so that it can be read without these files.

`gz.sim.sdf.assets` reads the result. URDF is converted to SDF, xacro is expanded, meshes and images are decoded; every
`<uri>` of an `<include>`, `<mesh>` or `<heightmap>` and every `<albedo_map>` becomes the address of an asset; textures
beyond a limit are left out. Elements keep their file and line
for messages, in the same attributes as those of an expanded xacro file.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from gz_course.sim.gz.sim.errors import Diagnostics, ResourceError, SdfError
from gz_course.sim.gz.sim.sdf.assets import LEFT_OUT, address, image_bytes, mesh_bytes
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.includes import read_root
from gz_course.sim.gz.sim.sdf.resources import FILES
from gz_course.sim.gz.sim.sdf.textures import Pixels
from gz_course.sim.gz.sim.sdf.urdf.xacro_file import FILES as FILES_ATTRIBUTE
from gz_course.sim.gz.sim.sdf.urdf.xacro_file import PLACE
from gz_course.sim.gz.sim.sdf.writer import to_xml

MOST_TEXTURE_BYTES = 24 << 20
"""Bytes of all textures that are handed over."""

_PATH = re.compile(r"(?<![\w:/.'])/(?:[^/\s:,]+/)*([^/\s:,]+)")  # an absolute one; the last part is a group


@dataclass
class Packed:
    """The address of a description, and all `assets` it refers to, by address."""

    description: str
    assets: dict[str, bytes] = field(default_factory=dict)


def pack(text: str, file: str) -> Packed:
    """Pack an SDF or URDF text; `file` is its name in messages and the base of relative addresses.

    Raises `SdfError` like a reader.
    """
    return _Packer().pack(text, file)


def without_folders(reason: str, uri: str) -> str:
    """Return a reason why what a `<uri>` names cannot be used; names of files take the place of paths."""
    name = uri.rstrip("/").rpartition("/")[2]
    reason = reason.replace(f"'{uri}'", f"'{name}'").partition("; it was looked for in ")[0]
    reason = _PATH.sub(r"\1", reason).removesuffix(f": {name}")
    return "".join(letter if letter.isprintable() else " " for letter in reason)


class _Packer:
    def __init__(self) -> None:
        self._assets: dict[str, bytes] = {}
        self._models: dict[Path, str] = {}
        self._open: list[Path] = []
        self._textures: dict[int, Pixels] = {}
        self._silent = Diagnostics(quiet=True)  # warnings are given when the result is read

    def pack(self, text: str, file: str) -> Packed:
        return Packed(self._text(text, file), self._assets)

    def _text(self, text: str, file: str) -> str:
        root = read_root(text, file, self._silent)
        files: dict[str, int] = {}
        waiting = [root]
        while waiting:
            element = waiting.pop()
            number = files.setdefault(element.file, len(files))
            element.attributes[PLACE] = f"{number}:{element.line}"
            if element.tag == "include":
                self._resolve(element, self._model)
            elif element.tag == "mesh":
                self._resolve(element, self._mesh)
            elif element.tag == "heightmap":
                self._resolve(element, self._image)
            elif element.tag == "albedo_map":
                self._name(element, element, self._texture)
            waiting.extend(element.children)
        root.attributes[FILES_ATTRIBUTE] = json.dumps(list(files))
        return self._keep(to_xml(root).encode(), "sdf")

    def _resolve(self, owner: Element, packed: Callable[[str, Element], str]) -> None:
        uri = owner.find("uri")
        if uri is not None:
            self._name(uri, owner, packed)

    def _name(self, uri: Element, owner: Element, packed: Callable[[str, Element], str]) -> None:
        if not uri.text:
            return
        try:
            uri.text = packed(uri.text, owner)
        except (ResourceError, OSError) as error:
            uri.text = LEFT_OUT + without_folders(str(error), uri.text)

    def _model(self, uri: str, include: Element) -> str:
        path = FILES.find_model(uri, include.folder)
        real = path.resolve()
        if real in self._open:
            raise SdfError(f"{include.where}: '{uri}' is included inside itself")
        if real not in self._models:
            self._open.append(real)
            self._models[real] = self._text(FILES.read_text(path), str(path))
            self._open.pop()
        return self._models[real]

    def _afford(self, pixels: Pixels) -> bool:
        """Tell whether a texture may be handed over, too; pictures must not use up the room for meshes and models."""
        if id(pixels) not in self._textures:
            if sum(each.nbytes for each in self._textures.values()) + pixels.nbytes > MOST_TEXTURE_BYTES:
                return False
            self._textures[id(pixels)] = pixels
        return True

    def _mesh(self, uri: str, mesh: Element) -> str:
        submesh = mesh.find("submesh")
        part = submesh.text_of("name") if submesh is not None else ""
        center = submesh.flag("center", False) if submesh is not None else False
        read = FILES.read_mesh(FILES.find_file(uri, mesh.folder), part, center)
        mesh.children = [child for child in mesh.children if child is not submesh]
        looks = [
            look if look.texture is None or self._afford(look.texture) else replace(look, texture=None)
            for look in read.looks
        ]
        return self._keep(mesh_bytes(replace(read, looks=tuple(looks))), "mesh")

    def _image(self, uri: str, heightmap: Element) -> str:
        return self._keep(image_bytes(FILES.read_image(FILES.find_file(uri, heightmap.folder))), "grey")

    def _texture(self, uri: str, material: Element) -> str:
        pixels = FILES.read_texture(FILES.find_file(uri, material.folder))
        if not self._afford(pixels):
            raise ResourceError(f"'{uri}' is one texture too many")
        return self._keep(image_bytes(pixels), "rgb")

    def _keep(self, data: bytes, kind: str) -> str:
        name = address(data, kind)
        self._assets[name] = data
        return name
