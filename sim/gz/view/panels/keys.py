"""Keys: what every key of the view does."""

from __future__ import annotations

import mujoco
from mujoco.studio.dear_imgui import dear_imgui as imgui

from gz_course.sim.gz.view.keys import KEYS
from gz_course.sim.gz.view.window import Window

_BLUE = imgui.Vec4(0.1, 0.27, 0.55, 1.0)


class Panel:
    """The last tab on the right."""

    TITLE = "Keys"
    PLACE = "right"
    ORDER = 23

    def __init__(self, window: Window) -> None:
        pass

    def build(self) -> None:
        for key in KEYS:
            imgui.TextColored(_BLUE, key.shown)
            imgui.Indent(12.0)
            imgui.TextWrapped(key.does)
            imgui.Unindent(12.0)

    def geoms(self) -> list[mujoco.MjvGeom]:
        return []

    def close(self) -> None:
        pass
