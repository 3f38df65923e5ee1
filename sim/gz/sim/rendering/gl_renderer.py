"""MuJoCo's OpenGL renderer for cameras, on a GPU or in software, by EGL or else OSMesa.

OpenGL is tested in a separate process, because a broken driver can crash the process that calls it.

Source: https://mujoco.readthedocs.io/en/stable/python.html (rendering)
"""

from __future__ import annotations

import functools
import importlib
import subprocess
import sys
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from gz_course.sim.gz.sim.physics.builder import VISUAL_GROUP
from gz_course.sim.gz.sim.rendering.shading import Colours, Shader

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.rendering.camera_sensor import CameraSensor

BACKENDS = ("egl", "osmesa")
PROBE_SECONDS = 30.0

PROBE = """
import sys
from importlib import import_module
import mujoco
context = import_module("mujoco." + sys.argv[1]).GLContext(64, 64)
context.make_current()
model = mujoco.MjModel.from_xml_string("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>")
drawing = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, drawing)
print("works" if drawing.currentBuffer == mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value else "no buffer")
"""


class GlRenderer:
    """Renders colours with MuJoCo's OpenGL renderer, without lens distortion."""

    def __init__(self, camera: CameraSensor, backend: str) -> None:
        self._camera = camera
        pinhole = camera.pinhole
        self._context = importlib.import_module(f"mujoco.{backend}").GLContext(pinhole.width, pinhole.height)
        self._rectangle = mujoco.MjrRect(0, 0, pinhole.width, pinhole.height)
        self._option = mujoco.MjvOption()
        self._option.geomgroup[:] = 0
        self._option.geomgroup[VISUAL_GROUP] = 1
        self._view = mujoco.MjvCamera()
        self._pixels = np.zeros((pinhole.height, pinhole.width, 3), dtype=np.uint8)
        self._depth = np.zeros((pinhole.height, pinhole.width), dtype=np.float32)
        self._shader = Shader(camera.world)

    def bind(self) -> None:
        model, pinhole = self._camera.world.model, self._camera.pinhole
        # Only the lights of the world are on; the head light carries the ambient light of the scene.
        model.vis.headlight.diffuse = model.vis.headlight.specular = (0.0, 0.0, 0.0)
        visual = model.vis.global_
        visual.offwidth = max(visual.offwidth, pinhole.width)
        visual.offheight = max(visual.offheight, pinhole.height)
        self._context.make_current()
        self._scene = mujoco.MjvScene(model, maxgeom=model.ngeom + 100)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = 0  # `Shader.background` fills what is empty
        self._drawing = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._drawing)

    def image(self) -> Colours:
        world, pinhole = self._camera.world, self._camera.pinhole
        self._context.make_current()
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        world.truth.refresh()
        mujoco.mj_comPos(world.model, world.data)
        mujoco.mj_camlight(world.model, world.data)
        mujoco.mjv_updateScene(
            world.model, world.data, self._option, None, self._view, everything, self._scene
        )  # fmt: skip
        position, quaternion = self._camera.caster.pose()
        axes = np.zeros(9)
        mujoco.mju_quat2Mat(axes, quaternion)
        ahead, up = axes.reshape(3, 3)[:, 0], axes.reshape(3, 3)[:, 2]
        fx, fy, cx, cy = pinhole.projection[:4]
        near = pinhole.near
        for eye in self._scene.camera:
            eye.pos, eye.forward, eye.up = position, ahead, up
            eye.frustum_near, eye.frustum_far = near, pinhole.far
            eye.frustum_bottom = -near * (pinhole.height - cy) / fy
            eye.frustum_top = near * cy / fy
            eye.frustum_center = near * (pinhole.width / 2.0 - cx) / fx
            eye.frustum_width = near * pinhole.width / 2.0 / fx
        mujoco.mjr_render(self._rectangle, self._scene, self._drawing)
        mujoco.mjr_readPixels(self._pixels, self._depth, self._rectangle, self._drawing)
        colours = np.flipud(self._pixels).reshape(-1, 3).T.astype(np.float32) / np.float32(255.0)
        empty = np.flatnonzero(np.flipud(self._depth).ravel() >= 1.0)
        colours[:, empty] = self._shader.background(
            (axes.reshape(3, 3) @ self._camera.directions[empty].T).astype(np.float32)
        )
        return colours


@functools.cache
def gl_backend() -> str | None:
    """Return `egl` or `osmesa` if MuJoCo can draw with it on this machine, else None. The first call takes about a
    second.
    """
    for name in BACKENDS:
        try:
            done = subprocess.run(
                [sys.executable, "-c", PROBE, name], capture_output=True, text=True, timeout=PROBE_SECONDS, check=False
            )
        except (OSError, subprocess.TimeoutExpired):
            continue
        if done.returncode == 0 and done.stdout.strip().endswith("works"):
            return name
    return None
