"""Adds the materials of visuals as MuJoCo materials and textures, for viewers that draw the MuJoCo model.

The ray-casting cameras take the pixels of `tex_data`, too. A plane has its texture once over its whole size, a mesh at
the places that its file states; on every other shape it is repeated on the six sides of a cube round the shape.

Source: https://mujoco.readthedocs.io/en/stable/XMLreference.html#asset-material, #asset-texture
Source: OpenGL 4.6 specification, section 8.13 (selection of cube map images)
"""

from __future__ import annotations

import mujoco
import numpy as np

from gz_course.sim.gz.sim.sdf.description import Look, Visual, WorldDescription
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.textures import fingerprint

_MOST_SHININESS = 128.0
"""OpenGL's largest exponent, which is MuJoCo's shininess 1."""


ZENITH, HORIZON = (0.30, 0.52, 0.85), (0.80, 0.88, 0.95)
"""The colours of the sky above and at the horizon."""
_SKY_SIDE = 64
_TURNS = 1, -1, 2, 0, -1, 1
"""Quarter turns of the sides of a cube that make the texture upright on its walls."""


def add_sky(spec: mujoco.MjSpec, world: WorldDescription) -> None:
    """Add what a viewer shows behind everything: the sky of `<scene>`, or its background colour."""
    sky = world.element.find("scene/sky") is not None
    made = spec.add_texture(name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX)
    made.builtin = mujoco.mjtBuiltin.mjBUILTIN_GRADIENT if sky else mujoco.mjtBuiltin.mjBUILTIN_FLAT
    made.rgb1, made.rgb2 = (ZENITH, HORIZON) if sky else (world.background, world.background)
    made.width = made.height = _SKY_SIDE if sky else 2


_LONGEST_SIDE = 512
"""The longest side of a cube's texture [px], of which there are six copies."""


class Materials:
    """The materials and textures already added to one spec."""

    def __init__(self, spec: mujoco.MjSpec) -> None:
        self._spec = spec
        self._textures: dict[tuple[bytes, bool], str] = {}
        self._materials: dict[tuple[object, ...], str] = {}

    def name_of(self, part: Visual, look: Look) -> str:
        """Return the name of the material for a look of a visual, added if it is new."""
        flat = part.geometry.kind == "plane" or part.geometry.mesh is not None
        texture = None if look.texture is None else self._texture(look, flat)
        stated = part.element.find("material")
        specular = max(_rgb(stated, "specular"))
        emission = max(_rgb(stated, "emissive"))
        exponent = stated.number("shininess", 0.0) if stated is not None else 0.0
        shininess = min(exponent / _MOST_SHININESS, 1.0) if exponent > 0.0 else 0.25
        key = (look.rgba, texture, specular, emission, shininess)
        if key not in self._materials:
            name = self._materials[key] = f"material{len(self._materials)}"
            material = self._spec.add_material(name=name, rgba=look.rgba)
            material.specular, material.shininess, material.emission = specular, shininess, emission
            if texture is not None:
                material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = texture
        return self._materials[key]

    def _texture(self, look: Look, flat: bool) -> str:
        pixels = look.texture
        assert pixels is not None
        key = fingerprint(pixels), flat
        if key not in self._textures:
            name = self._textures[key] = f"texture{len(self._textures)}"
            kind = mujoco.mjtTexture
            made = self._spec.add_texture(name=name, type=kind.mjTEXTURE_2D if flat else kind.mjTEXTURE_CUBE)
            made.nchannel = 3
            side = pixels
            if not flat:
                # The sides +x -x +y -y +z -z of a cube are squares below each other, each turned as OpenGL reads it.
                rows, columns = pixels.shape[:2]
                length = min(max(rows, columns), _LONGEST_SIDE)
                square = np.arange(length)
                side = pixels[square * rows // length][:, square * columns // length]
                side = np.concatenate([np.rot90(side, turns) for turns in _TURNS])
            made.height, made.width = side.shape[:2]
            made.data = side.tobytes()
        return self._textures[key]


def _rgb(material: Element | None, tag: str) -> tuple[float, ...]:
    found = material.find(tag) if material is not None else None
    if found is None or len(found.text.split()) not in (3, 4):
        return (0.0,)
    return tuple(min(1.0, max(0.0, value)) for value in found.floats(len(found.text.split()))[:3])
