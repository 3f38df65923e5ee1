"""The window in the browser: Studio's picture of the world, and around it the panels of `gz_course.sim.gz.view.panels`.

`Window` is a plugin of Studio's viewer. It takes mouse and keys, follows the selected entity, and lays the panels out
as Gazebo does: the controls of the world on top, entities on the left, tools on the right, a status line below.

Source: mujoco.studio.app.plugins and mujoco.studio.plugin of mujoco-studio 4.0.0
"""

from __future__ import annotations

import contextlib
import importlib
import pkgutil
from typing import Any, Protocol

import mujoco
import numpy as np
from mujoco.studio import messages, plugin, ux
from mujoco.studio.app import inputs
from mujoco.studio.dear_imgui import dear_imgui as imgui

from gz_course.sim.gz.view import panels
from gz_course.sim.gz.view.description import Description
from gz_course.sim.gz.view.dragging import Dragging
from gz_course.sim.gz.view.entities import Entity, link_of_body, models_of
from gz_course.sim.gz.view.keyboard import Keyboard
from gz_course.sim.gz.view.world_link import WorldLink

_LEFT_WIDTH, _RIGHT_WIDTH, _TOP_HEIGHT, _BOTTOM_HEIGHT = 250.0, 320.0, 40.0, 34.0
_NARROW = 700.0
"""Width [pixels] of a page, for example a frame in a notebook, that opens without the panels at its sides."""
_TALL, _BELOW_HEIGHT = 620.0, 330.0
"""Height [pixels] of a narrow page, for example beside a notebook, that has tools below the picture, and theirs."""
_LARGEST = 50.0
"""Radius [m] from which on a shape is scenery, and does not move the camera away."""
_GREY = imgui.Vec4(0.33, 0.33, 0.33, 1.0)
_DOCKS = int(imgui.DockNodeFlags.PassthruCentralNode) | int(imgui.DockNodeFlags.AutoHideTabBar)
_DOCK_SPACE = 1 << 10
"""ImGuiDockNodeFlags_DockSpace, which the bindings leave out."""
_BAR = int(imgui.WindowFlags.NoTitleBar) | int(imgui.WindowFlags.NoScrollbar) | int(imgui.WindowFlags.NoMove)


class Panel(Protocol):
    """What a file in `panels` defines as `class Panel`."""

    TITLE: str
    PLACE: str
    """`top`, `left` or `right`."""
    ORDER: int

    def __init__(self, window: Window) -> None: ...

    def build(self) -> None:
        """Draw the panel with Dear ImGui; called once a picture, in the thread of the viewer."""

    def geoms(self) -> list[mujoco.MjvGeom]:
        """Return what is drawn in the world besides its models."""

    def close(self) -> None: ...


class Window(plugin.ViewerPlugin):
    """The plugin; `link` leads to the world, `selected` is the name of an entity or empty."""

    def __init__(self, link: WorldLink) -> None:
        self.link = link
        self.selected = ""
        self.followed = ""
        self.models: dict[str, Entity] = {}
        self.hidden: set[str] = set()
        """The titles of the panels that were closed."""
        self._to_front = ""
        self._ux_state = ux.UxState()
        self._dragging = Dragging(link)
        self.keyboard = Keyboard(self)
        self.description = Description()
        self.still = False
        """True if the reader of the page wants motion reduced."""
        self._laid_out = (0.0, 0.0)
        found = [importlib.import_module(f"{panels.__name__}.{m.name}") for m in pkgutil.iter_modules(panels.__path__)]
        made: list[Panel] = [module.Panel(self) for module in found]
        self.panels = sorted(made, key=lambda each: each.ORDER)

    @property
    def model(self) -> mujoco.MjModel:
        return self.viewer.model

    @property
    def data(self) -> mujoco.MjData:
        return self.viewer.data

    def panel(self, title: str) -> Any:
        """Return the panel of this title."""
        return next(each for each in self.panels if title == each.TITLE)

    def select(self, name: str) -> None:
        """Select an entity by its name, or nothing with an empty one; a link that moves can be dragged."""
        self.selected = name
        entity = self.entity(name)
        perturb = self.viewer.perturb
        perturb.select = entity.bodies[0] if entity is not None and entity.bodies else 0
        perturb.localpos[:] = 0.0

    def show_panel(self, title: str) -> None:
        """Bring a panel to the front, also a closed one."""
        self.hidden.discard(title)
        self._to_front = title

    def told(self, still: bool) -> str:
        """Return what the page reads aloud, as JSON; `still` says that its reader wants motion reduced."""
        if still and not self.still:
            self.panel("Entity tree").follows = False
        self.still = still
        return self.description.as_json()

    def entity(self, name: str) -> Entity | None:
        """Return a model or link of the world; None if it is not there (any more)."""
        model = self.models.get(name.split("::", 1)[0])
        return model if model is None or "::" not in name else model.links.get(name)

    def follow(self, name: str) -> None:
        """Keep the camera on an entity; with an empty name it stays where it is."""
        self.followed = name
        entity = self.entity(name)
        camera = self.viewer.camera
        if entity is not None and entity.bodies:
            camera.type, camera.trackbodyid = int(mujoco.mjtCamera.mjCAMERA_TRACKING), entity.bodies[0]
            self._ux_state.camera_index = ux.TRACKING_CAMERA_IDX
        else:
            camera.type, camera.trackbodyid = int(mujoco.mjtCamera.mjCAMERA_FREE), -1
            self._ux_state.camera_index = ux.TUMBLE_CAMERA_IDX
            if entity is not None:
                camera.lookat[:] = entity.centre(self.data)

    def look_at_all(self) -> None:
        """Put the camera where the whole world is seen."""
        self.follow("")
        camera = self.viewer.camera
        mujoco.mjv_defaultFreeCamera(self.model, camera)
        bounded = [g for g in range(self.model.ngeom) if 0.0 < self.model.geom_rbound[g] < _LARGEST]
        if bounded:
            places, radii = self.data.geom_xpos[bounded], self.model.geom_rbound[bounded, None]
            low, high = (places - radii).min(axis=0), (places + radii).max(axis=0)
            camera.lookat[:] = (low + high) / 2.0
            camera.distance = max(1.0, 0.85 * float(np.linalg.norm(high - low)))
        camera.azimuth, camera.elevation = 60.0, -38.0

    @messages.handler
    def on_viewer_init(self, _: plugin.ViewerInitEvent) -> None:
        ux.setup_theme(ux.GuiTheme.LIGHT)
        self.viewer.vis_options.flags[int(mujoco.mjtVisFlag.mjVIS_PERTFORCE)] = 1

    @messages.handler
    def on_model(self, _: messages.PostModelEvent) -> None:
        """Find the entities of a new model; selection and camera stay with theirs, by name."""
        first = not self.models
        self.models = models_of(self.model)
        self.viewer.perturb.active = 0
        if first:
            self.look_at_all()
        self.select(self.selected if self.entity(self.selected) is not None else "")
        if self.followed:
            self.follow(self.followed if self.entity(self.followed) is not None else "")

    @messages.handler
    def on_update(self, _: messages.UpdateEvent) -> None:
        """Take mouse and keys, and draw what belongs to the panels into the world."""
        viewer = self.viewer
        chosen = viewer.perturb.select
        inputs.handle_mouse_events(
            self.model,
            self.data,
            viewer.camera,
            viewer.vis_options,
            viewer.perturb,
            self._ux_state,
            move_camera=viewer.client_camera is None,
        )
        if viewer.perturb.select != chosen:
            self.selected = link_of_body(self.model, viewer.perturb.select)
        if viewer.camera.type == int(mujoco.mjtCamera.mjCAMERA_TRACKING):
            body = viewer.camera.trackbodyid
            self.followed = self.followed or link_of_body(self.model, body)
        self.keyboard.update()
        along = self.keyboard.push_along
        self._dragging.update(self.model, self.data, viewer.perturb, along, paused=self.link.paused)
        self.description.update(self)
        viewer.extra_geoms[:] = [geom for panel in self.panels for geom in panel.geoms()]

    def toggle_pause(self) -> None:
        if self.link.paused:
            self.link.play()
        else:
            self.link.pause()

    @messages.handler(priority=messages.Priority.CRITICAL)
    def on_build_gui(self, _: messages.BuildGuiEvent) -> None:
        self._lay_out()
        for panel in self.panels:
            if panel.TITLE in self.hidden:
                continue
            if self._to_front == panel.TITLE:
                imgui.SetNextWindowFocus()
                self._to_front = ""
            shown, opened = imgui.Begin(panel.TITLE, True, _BAR if panel.PLACE == "top" else 0)
            try:
                if shown:
                    panel.build()
            except Exception as error:  # a panel that breaks down must not take the picture with it
                self.link.said = f"panel '{panel.TITLE}' is closed: {type(error).__name__}: {error}"
                opened = False
            finally:
                imgui.End()
            if not opened:
                self.hidden.add(panel.TITLE)
        imgui.Begin("Status", None, _BAR)
        imgui.TextColored(_GREY, "H: keys  ")
        imgui.SameLine()
        imgui.TextUnformatted(self.link.said)
        if self.selected:
            imgui.SameLine()
            imgui.TextColored(_GREY, f"   {self.selected}: Ctrl and the right mouse button drag, the left one turns")
        imgui.End()
        self.viewer.camera_index = self._ux_state.camera_index

    def _lay_out(self) -> None:
        """Dock the panels around the picture; again when the page has another size."""
        space = imgui.DockSpaceOverMainViewport(0, _DOCKS)
        display = imgui.GetIO().DisplaySize
        size = (display.x, display.y)
        if size == self._laid_out or min(size) < 200.0:
            return
        below = size[0] < _NARROW and size[1] >= _TALL
        if self._laid_out == (0.0, 0.0) and size[0] < _NARROW:
            tools = [panel.TITLE for panel in self.panels if panel.PLACE == "right"]
            self.hidden = {panel.TITLE for panel in self.panels if panel.PLACE != "top"} - set(tools[:below])
        self._laid_out = size
        imgui.DockBuilderRemoveNode(space)
        imgui.DockBuilderAddNode(space, _DOCKS | _DOCK_SPACE)
        imgui.DockBuilderSetNodeSize(space, display)
        top, rest = imgui.DockBuilderSplitNode(space, imgui.Dir.Up, _TOP_HEIGHT / size[1])
        bottom, rest = imgui.DockBuilderSplitNode(rest, imgui.Dir.Down, _BOTTOM_HEIGHT / (size[1] - _TOP_HEIGHT))
        width = size[0]
        left, rest = imgui.DockBuilderSplitNode(rest, imgui.Dir.Left, min(0.3, _LEFT_WIDTH / width))
        side, share = (imgui.Dir.Down, _BELOW_HEIGHT / size[1]) if below else (imgui.Dir.Right, _RIGHT_WIDTH / width)
        right, rest = imgui.DockBuilderSplitNode(rest, side, min(0.6 if below else 0.4, share))
        nodes = {"top": top, "left": left, "right": right}
        for panel in self.panels:
            imgui.DockBuilderDockWindow(panel.TITLE, nodes[panel.PLACE])
        imgui.DockBuilderDockWindow("Status", bottom)
        imgui.DockBuilderFinish(space)

    def close(self) -> None:
        for panel in self.panels:
            with contextlib.suppress(RuntimeError, OSError):
                panel.close()
