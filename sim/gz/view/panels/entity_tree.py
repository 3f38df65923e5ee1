"""Entity tree: the models of the world and their links; a click selects and follows, a button removes.

`Remove` calls the service `/world/W/remove`.
"""

from __future__ import annotations

import mujoco
from mujoco.studio.dear_imgui import dear_imgui as imgui

from gz_course.sim.gz.view.entities import Entity
from gz_course.sim.gz.view.window import Window

_OPEN_ON_ARROW = int(imgui.TreeNodeFlags.OpenOnArrow) | int(imgui.TreeNodeFlags.SpanAvailWidth)
_LEAF = _OPEN_ON_ARROW | int(imgui.TreeNodeFlags.Leaf)
_SELECTED = int(imgui.TreeNodeFlags.Selected)


class Panel:
    """The list on the left."""

    TITLE = "Entity tree"
    PLACE = "left"
    ORDER = 10

    def __init__(self, window: Window) -> None:
        self._window = window
        self.follows = True
        """Whether a click on an entity makes the camera follow it."""

    def build(self) -> None:
        window = self._window
        _, self.follows = imgui.Checkbox("Follow", self.follows)
        imgui.SameLine()
        if imgui.Button("View all"):
            window.look_at_all()
        imgui.SameLine()
        imgui.BeginDisabled(not window.selected)
        if imgui.Button("Remove"):
            self.remove_selected()
        imgui.EndDisabled()
        imgui.Separator()
        for entity in list(window.models.values()):
            if self._line(entity, bool(entity.links)):
                for link in entity.links.values():
                    if self._line(link, False):
                        imgui.TreePop()
                imgui.TreePop()

    def _line(self, entity: Entity, has_links: bool) -> bool:
        """Draw one line; return whether it is open."""
        flags = (_OPEN_ON_ARROW if has_links else _LEAF) | (_SELECTED if entity.name == self._window.selected else 0)
        opened = imgui.TreeNodeEx(entity.name.rpartition("::")[2] + f"###{entity.name}", flags)
        if imgui.IsItemClicked() and not imgui.IsItemToggledOpen():
            self.click(entity.name)
        return bool(opened)

    def click(self, name: str) -> None:
        """Select an entity, and follow it if that is switched on."""
        self._window.select(name)
        if self.follows:
            self._window.follow(name)

    def remove_selected(self) -> None:
        """Remove the model that is selected, or whose link is."""
        self._window.link.remove(self._window.selected.split("::", 1)[0])

    def geoms(self) -> list[mujoco.MjvGeom]:
        return []

    def close(self) -> None:
        pass
