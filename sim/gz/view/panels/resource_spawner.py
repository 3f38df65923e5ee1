"""Resource spawner: put a shape or a model of GZ_SIM_RESOURCE_PATH into the world.

`Insert` calls the service `/world/W/create`; the place is the point that the camera looks at.
"""

from __future__ import annotations

import mujoco
from mujoco.studio.dear_imgui import dear_imgui as imgui

from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_MODELS, resource_paths
from gz_course.sim.gz.view.window import Window

SHAPES = {
    "box": ("<box><size>0.4 0.4 0.4</size></box>", 0.2, (0.027, 0.027, 0.027)),
    "sphere": ("<sphere><radius>0.2</radius></sphere>", 0.2, (0.016, 0.016, 0.016)),
    "cylinder": ("<cylinder><radius>0.2</radius><length>0.4</length></cylinder>", 0.2, (0.023, 0.023, 0.02)),
}
"""Geometry, height of the middle above the ground [m], and moments of inertia of 1 kg [kg m²], by name."""
_ABOVE = 0.02
"""Height [m] above the ground at which a shape is let go."""


class Panel:
    """The second tab on the left."""

    TITLE = "Resource spawner"
    PLACE = "left"
    ORDER = 11

    def __init__(self, window: Window) -> None:
        self._window = window
        self.place: list[float] = [0.0, 0.0]
        self.at_camera = True
        """Whether the place is the point that the camera looks at, or `place`."""
        self._models = models()

    def build(self) -> None:
        _, self.at_camera = imgui.Checkbox("where the camera looks", self.at_camera)
        imgui.BeginDisabled(self.at_camera)
        _, self.place = imgui.InputFloatN("x y [m]", self.place, "%.2f")
        imgui.EndDisabled()
        imgui.SeparatorText("Shapes")
        for shape in SHAPES:
            if imgui.Button(shape):
                self.insert_shape(shape)
            imgui.SameLine()
        imgui.NewLine()
        imgui.SeparatorText("Models")
        for name in self._models:
            if imgui.Selectable(name):
                self.insert_model(name)
        if imgui.Button("Search again"):
            self._models = models()

    def _where(self) -> tuple[float, float]:
        x, y = self._window.viewer.camera.lookat[:2] if self.at_camera else self.place
        return float(x), float(y)

    def insert_shape(self, shape: str) -> None:
        """Insert a shape of 1 kg."""
        geometry, middle, (ixx, iyy, izz) = SHAPES[shape]
        inertia = f"<ixx>{ixx}</ixx><iyy>{iyy}</iyy><izz>{izz}</izz>"
        self._window.link.create(
            f"<sdf version='1.10'><model name='{shape}'><link name='link'>"
            f"<inertial><mass>1</mass><inertia>{inertia}</inertia></inertial>"
            f"<collision name='collision'><geometry>{geometry}</geometry></collision>"
            f"<visual name='visual'><geometry>{geometry}</geometry>"
            "<material><diffuse>0.9 0.55 0.1 1</diffuse></material></visual></link></model></sdf>",
            shape,
            (*self._where(), middle + _ABOVE),
        )

    def insert_model(self, name: str) -> None:
        self._window.link.create(name, name, (*self._where(), 0.0))

    def geoms(self) -> list[mujoco.MjvGeom]:
        return []

    def close(self) -> None:
        pass


def models() -> list[str]:
    """Return the names of the folders with a model in GZ_SIM_RESOURCE_PATH and of the built-in models, sorted."""
    found = {
        path.parent.name for folder in (*resource_paths(), BUILT_IN_MODELS) for path in folder.glob("*/model.config")
    }
    return sorted(found)
