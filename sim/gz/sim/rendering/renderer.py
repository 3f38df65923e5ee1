"""The render engines of cameras, by the name that `gz sim --render-engine` takes.

`raycast` casts rays and gives the same bytes in every run: it is that of the library and of graded runs. `fast`
(`--fast-camera`) casts a quarter of them. `mujoco` draws with OpenGL. `auto`, the default of `gz sim`, casts rays and
changes to OpenGL where that works and is faster. Gazebo's own names (`ogre`, `ogre2`, `optix`) mean `raycast`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import LOG, SimError
from gz_course.sim.gz.sim.rendering.gl_renderer import GlRenderer, gl_backend
from gz_course.sim.gz.sim.rendering.quicker_renderer import QuickerRenderer
from gz_course.sim.gz.sim.rendering.ray_renderer import FastRenderer, RayRenderer
from gz_course.sim.gz.sim.rendering.shading import Colours

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.rendering.camera_sensor import CameraSensor

RAYCAST, FAST, AUTO, MUJOCO = "raycast", "fast", "auto", "mujoco"
OF_GAZEBO = ("ogre", "ogre2", "optix")


class Renderer(Protocol):
    """Makes the colour images of one camera."""

    def bind(self) -> None:
        """Prepare for MuJoCo's model, which was just built."""

    def image(self) -> Colours:
        """Return the present image (3, height * width), values 0..1, without noise."""


def check_engine(name: str) -> str:
    """Return the name of our engine for a `--render-engine`. Raises SimError for an unknown name and for missing
    OpenGL.
    """
    if name in ("", RAYCAST):
        return RAYCAST
    if name in (FAST, AUTO):
        return name
    if name in OF_GAZEBO:
        LOG.info("render engine '%s' is Gazebo's; cameras and lidars are ray-cast here", name)
        return RAYCAST
    if name != MUJOCO:
        hint = did_you_mean(name, (RAYCAST, FAST, AUTO, MUJOCO, *OF_GAZEBO), listing="known names are")
        raise SimError(f"there is no render engine '{name}'{hint}")
    if gl_backend() is None:
        raise SimError(
            "render engine 'mujoco' needs OpenGL without a screen, which does not work on this machine; "
            "install EGL (Debian: libegl1 libgl1-mesa-dri) or OSMesa (libosmesa6), or use the default, raycast"
        )
    return MUJOCO


def renderer_for(camera: CameraSensor) -> Renderer:
    """Return a renderer of the engine that the world was started with."""
    world: Any = camera.world
    engine = getattr(world, "render_engine", RAYCAST)
    if engine == MUJOCO:
        backend = gl_backend()
        if backend is not None:
            return GlRenderer(camera, backend)
    if engine == AUTO and not camera.pinhole.distorted:
        return QuickerRenderer(camera)
    return FastRenderer(camera) if engine == FAST else RayRenderer(camera)
