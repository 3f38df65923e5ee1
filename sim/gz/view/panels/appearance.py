"""View: visuals and collisions, grid, sky, shadows; further settings of Studio's own."""

from __future__ import annotations

import mujoco
import numpy as np
from mujoco.studio import ux
from mujoco.studio.dear_imgui import dear_imgui as imgui

from gz_course.sim.gz.sim.physics.geoms import COLLISION_GROUP, VISUAL_GROUP
from gz_course.sim.gz.view.sensor_drawings import line
from gz_course.sim.gz.view.window import Window

_GRID_CELLS = 10
"""Cells of 1 m from the middle of the grid to its side."""
_GRID_RGBA = np.array([0.35, 0.35, 0.35, 1.0], np.float32)
_FLAGS = {
    "shadows": mujoco.mjtRndFlag.mjRND_SHADOW,
    "reflections": mujoco.mjtRndFlag.mjRND_REFLECTION,
    "sky": mujoco.mjtRndFlag.mjRND_SKYBOX,
    "fog": mujoco.mjtRndFlag.mjRND_FOG,
    "wireframe": mujoco.mjtRndFlag.mjRND_WIREFRAME,
}
_OPTIONS = {"transparent": mujoco.mjtVisFlag.mjVIS_TRANSPARENT, "lights": mujoco.mjtVisFlag.mjVIS_LIGHT}
_FRAMED = int(imgui.TreeNodeFlags.SpanAvailWidth)


class Panel:
    """The third tab on the right."""

    TITLE = "View"
    PLACE = "right"
    ORDER = 22

    def __init__(self, window: Window) -> None:
        self._window = window
        self.grid = True
        self._lines = _grid()

    def show(self, group: int, shown: bool) -> None:
        """Show or hide all geoms of a group: VISUAL_GROUP or COLLISION_GROUP."""
        self._window.viewer.vis_options.geomgroup[group] = shown

    def build(self) -> None:
        viewer = self._window.viewer
        for label, group in (("visuals", VISUAL_GROUP), ("collisions", COLLISION_GROUP)):
            changed, shown = imgui.Checkbox(label, bool(viewer.vis_options.geomgroup[group]))
            if changed:
                self.show(group, shown)
        _, self.grid = imgui.Checkbox("grid (1 m)", self.grid)
        flags = list(viewer.render_flags.flags)
        for label, flag in _FLAGS.items():
            changed, on = imgui.Checkbox(label, bool(flags[int(flag)]))
            if changed:
                flags[int(flag)] = int(on)
                viewer.render_flags.flags = flags
        for label, flag in (
            ("transparent", mujoco.mjtVisFlag.mjVIS_TRANSPARENT),
            ("light", mujoco.mjtVisFlag.mjVIS_LIGHT),
        ):
            changed, on = imgui.Checkbox(label, bool(viewer.vis_options.flags[int(flag)]))
            if changed:
                viewer.vis_options.flags[int(flag)] = on
        if imgui.TreeNodeEx("MuJoCo's names", _FRAMED):
            ux.label_selection_gui(viewer.vis_options)
            ux.frame_selection_gui(viewer.vis_options)
            ux.groups_gui(viewer.model, viewer.vis_options)
            imgui.TreePop()

    def geoms(self) -> list[mujoco.MjvGeom]:
        return self._lines if self.grid else []

    def close(self) -> None:
        pass


def _grid() -> list[mujoco.MjvGeom]:
    side, height = float(_GRID_CELLS), 0.002
    lines = []
    for at in np.linspace(-side, side, 2 * _GRID_CELLS + 1):
        for start, end in (((at, -side, height), (at, side, height)), ((-side, at, height), (side, at, height))):
            lines.append(line(np.array(start), np.array(end), _GRID_RGBA, 0.003))
    return lines
