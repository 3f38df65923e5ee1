"""A window without a browser, and the world that it shows; a context in which its panels are drawn."""

from __future__ import annotations

import threading
import uuid
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest
from mujoco.studio import ux
from mujoco.studio.dear_imgui import dear_imgui as imgui

from gz_course.sim.gz.sim.sdf.description import Plugin
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.server import Server
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope
from gz_course.sim.gz.view.window import Window
from gz_course.sim.gz.view.world_link import WorldLink
from gz_course.tests.eventually import within

DEADLINE = 120.0
eventually = within(DEADLINE)


class Shown:
    """A window without a browser, and the world that it shows, which runs in a thread."""

    def __init__(self) -> None:
        options = NodeOptions(scope=Scope.PROCESS, partition=uuid.uuid4().hex)
        name = "gz_course::systems::ViewBroadcaster"
        element = Element("plugin", {"name": name, "filename": ""}, file="test")
        self.world = World.load("lidar_room.sdf", server_plugins=[Plugin(name, "", element)])
        self.server = Server(self.world, Node(options))
        self.server.paused = True
        self.stop = threading.Event()
        pace = {"stop": self.stop, "real_time_factor": 1.0}
        self.thread = threading.Thread(target=self.server.run, kwargs=pace, daemon=True)
        self.thread.start()
        self.node = Node(options)
        self.viewer: Any = SimpleNamespace(
            camera=mujoco.MjvCamera(),
            perturb=mujoco.MjvPerturb(),
            vis_options=mujoco.MjvOption(),
            extra_geoms=[],
            render_flags=ux.RenderFlags(),
            client_camera=None,
            camera_index=0,
            upload_image=lambda *what: 1,
            model=None,
            data=None,
        )
        self.link = WorldLink(Node(options), self.take_model, self.take_state)
        self.window = Window(self.link)
        self.window.viewer = self.viewer
        assert self.link.find_world() == "lidar_room"
        self.link.follow("lidar_room")
        self.has("robot")
        eventually(lambda: self.link.stats.HasField("header"), "statistics")

    def take_model(self, model: mujoco.MjModel) -> None:
        self.viewer.model, self.viewer.data = model, mujoco.MjData(model)
        mujoco.mj_forward(model, self.viewer.data)
        self.window.on_model(None)  # type: ignore[arg-type]

    def take_state(self, state: np.ndarray) -> None:
        self.state = state

    def has(self, name: str) -> Any:
        return eventually(lambda: self.window.entity(name), f"{name} appears")

    def close(self) -> None:
        self.window.close()
        self.link.close()
        self.stop.set()
        self.thread.join(DEADLINE)
        self.world.close()
        for node in (self.node, self.link.node, self.server.node):
            node.close()


@pytest.fixture(scope="module")
def running() -> Iterator[Shown]:
    shown = Shown()
    yield shown
    shown.close()


@pytest.fixture
def shown(running: Shown) -> Shown:
    """Return the world as it starts: paused at time zero, with no request of the test before under way."""
    eventually(lambda: not running.link.waits, "what was asked before is answered")
    running.link.pause()
    running.link.reset()
    eventually(lambda: not running.link.waits, "both are answered")
    eventually(lambda: running.link.stats.paused and running.world.iterations == 0, "a paused world at its start")
    return running


@pytest.fixture
def pictures(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    """Let panels be drawn without a browser."""
    monkeypatch.chdir(tmp_path)  # where a context leaves its settings when it ends, as imgui.ini
    context = imgui.CreateContext()
    imgui.SetCurrentContext(context)
    ux.set_imgui_context(context)
    io = imgui.GetIO()
    io.DisplaySize = imgui.Vec2(1280, 800)
    io.ConfigFlags = int(io.ConfigFlags) | int(imgui.ConfigFlags.DockingEnable)
    io.BackendFlags = int(io.BackendFlags) | int(imgui.BackendFlags.RendererHasTextures)
    yield
    imgui.DestroyContext(context)


def draw(window: Window) -> None:
    imgui.NewFrame()
    window.on_update(None)  # type: ignore[arg-type]
    window.on_build_gui(None)  # type: ignore[arg-type]
    imgui.Render()
