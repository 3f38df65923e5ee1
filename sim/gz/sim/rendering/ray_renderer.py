"""The ray-casting renderer of cameras: always available, and reproducible byte by byte.

`FastRenderer` (`--fast-camera`) casts the rays of every second row and column only.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gz_course.sim.gz.sim.rendering.shading import Colours, Shader
from gz_course.sim.gz.sim.rendering.tile_caster import TileCaster
from gz_course.sim.gz.sim.rendering.tiles import Tiles

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.rendering.camera_sensor import CameraSensor


class RayRenderer:
    """Renders colours by casting the camera's rays."""

    def __init__(self, camera: CameraSensor) -> None:
        self._camera = camera
        self._shader = Shader(camera.world)

    def bind(self) -> None:
        self._shader.bind()

    def image(self) -> Colours:
        return self._shader.colours(self._camera.cast())


class FastRenderer:
    """Renders a quarter of the pixels, each for a square of four."""

    def __init__(self, camera: CameraSensor) -> None:
        pinhole = camera.pinhole
        self._width, self._height = pinhole.width, pinhole.height
        middles = camera.directions.reshape(self._height, self._width, 3)
        middles = np.pad(middles, ((0, self._height % 2), (0, self._width % 2), (0, 0)), mode="edge")
        middles = middles[::2, ::2] + middles[1::2, ::2] + middles[::2, 1::2] + middles[1::2, 1::2]
        self._across = middles.shape[1]
        rays = middles.reshape(-1, 3) / np.linalg.norm(middles.reshape(-1, 3), axis=1, keepdims=True)
        along = rays[:, 0]
        tiles = Tiles(self._across, middles.shape[0], rays, pinhole.near / along, pinhole.far / along)
        self._caster = TileCaster(camera.world, camera.description, tiles, camera.mask)
        self._shader = Shader(camera.world)

    def bind(self) -> None:
        self._caster.bind()
        self._shader.bind()

    def image(self) -> Colours:
        colours = self._shader.colours(self._caster.look()).reshape(3, -1, self._across)
        whole = colours.repeat(2, axis=1).repeat(2, axis=2)[:, : self._height, : self._width]
        return whole.reshape(3, -1)
