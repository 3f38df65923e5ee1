"""Render engines: accepted names, and agreement of the OpenGL images, if available, with the ray-cast ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.rendering import quicker_renderer, renderer
from gz_course.sim.gz.sim.rendering.gl_renderer import GlRenderer, gl_backend
from gz_course.sim.gz.sim.rendering.quicker_renderer import PATIENCE, TRIES, OpenGlSearch, QuickerRenderer
from gz_course.sim.gz.sim.rendering.ray_renderer import FastRenderer, RayRenderer
from gz_course.sim.gz.sim.rendering.renderer import check_engine
from gz_course.sim.gz.sim.world import World

Load = Callable[..., World]

SCENE = """<scene><ambient>0.4 0.4 0.4 1</ambient><sky/></scene>
<light name='sun' type='directional'><direction>0.4 0.3 -1</direction><diffuse>0.6 0.6 0.6 1</diffuse></light>
<model name='floor'><static>1</static><link name='l'><visual name='v'>
 <geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
 <material><diffuse>0.8 0.8 0.8 1</diffuse></material></visual></link></model>
<model name='box'><static>1</static><pose>3 0.5 0.5 0 0 0.4</pose><link name='l'><visual name='v'>
 <geometry><box><size>1 1 1</size></box></geometry>
 <material><diffuse>0.8 0.2 0.1 1</diffuse></material></visual></link></model>
<model name='rig'><static>1</static><pose>0 0 1 0 0.1 0</pose><link name='l'><sensor name='eye' type='camera'>
 <camera><horizontal_fov>1.2</horizontal_fov><image><width>160</width><height>120</height></image>
 <clip><near>0.1</near><far>200</far></clip></camera></sensor></link></model>"""


def eye(world: World) -> Any:
    (camera,) = next(system for system in world.systems if system.name == "Sensors").sensors  # type: ignore[attr-defined]
    return camera


class Found(OpenGlSearch):
    """A search that has ended."""

    def __init__(self, backend: str) -> None:
        super().__init__()
        self.backend, self.done = backend, True


class Instant:
    """A renderer that stands for OpenGL and takes no time."""

    def __init__(self, camera: Any, backend: str) -> None:
        self.backend, self.binds = backend, 0

    def bind(self) -> None:
        self.binds += 1

    def image(self) -> str:
        return "drawn"


@pytest.mark.parametrize("name", ["", "raycast", "ogre", "ogre2", "optix"])
def test_the_names_of_gazebo_mean_the_default(name: str) -> None:
    assert check_engine(name) == "raycast"


def test_an_unknown_engine_is_answered_with_the_nearest() -> None:
    with pytest.raises(SimError, match="no render engine 'mojoco'; did you mean 'mujoco'"):
        check_engine("mojoco")


def test_no_opengl_is_said_before_anything_breaks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(renderer, "gl_backend", lambda: None)
    with pytest.raises(SimError, match="needs OpenGL without a screen, which does not work on this machine"):
        check_engine("mujoco")


def test_opengl_shows_what_the_rays_show(load_text: Load) -> None:
    backend = gl_backend()
    if backend is None:
        pytest.skip("MuJoCo cannot draw with OpenGL on this machine")
    world = load_text(SCENE)
    (camera,) = next(system for system in world.systems if system.name == "Sensors").sensors  # type: ignore[attr-defined]
    cast: Any = camera._renderer.image().T.reshape(120, 160, 3)
    gl = GlRenderer(camera, backend)
    gl.bind()
    drawn = gl.image().T.reshape(120, 160, 3)
    difference = np.abs(drawn - cast).max(axis=2)
    assert (difference > 0.1).mean() < 0.04, "only edges and shadows may differ"
    assert np.median(difference) < 0.03
    red = [(picture[:, :, 0] > 2 * picture[:, :, 2]).nonzero() for picture in (cast, drawn)]
    for axis in (0, 1):
        assert red[0][axis].mean() == pytest.approx(red[1][axis].mean(), abs=0.5)


def test_the_library_casts_rays_and_the_program_takes_the_quicker(load_text: Load) -> None:
    assert isinstance(eye(load_text(SCENE))._renderer, RayRenderer)
    world = load_text(SCENE, render_engine="auto")
    assert isinstance(eye(world)._renderer, QuickerRenderer)
    assert isinstance(eye(load_text(SCENE, render_engine="fast"))._renderer, FastRenderer)
    lens = "<distortion><k1>0.1</k1></distortion></camera>"
    bent = load_text(SCENE.replace("</camera>", lens), render_engine="auto")
    assert isinstance(eye(bent)._renderer, RayRenderer), "OpenGL cannot bend the picture"


def test_the_quicker_renderer_is_taken_after_some_images(load_text: Load, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(quicker_renderer, "GlRenderer", Instant)
    camera = eye(load_text(SCENE))
    same = camera._renderer.image()
    made = QuickerRenderer(camera, Found("egl"))
    made.bind()
    for _ in range(PATIENCE + 1 + TRIES):
        assert made.chosen is None
        assert (made.image() == same).all()
    assert isinstance(made.chosen, Instant) and made.chosen.backend == "egl"
    made.bind()
    assert made.image() == "drawn" and made.chosen.binds == 2


@pytest.mark.parametrize("backend", ["", "missing_backend"])
def test_without_opengl_rays_are_cast(load_text: Load, monkeypatch: pytest.MonkeyPatch, backend: str) -> None:
    monkeypatch.setattr(quicker_renderer, "PATIENCE", 0)
    camera = eye(load_text(SCENE))
    made = QuickerRenderer(camera, Found(backend))
    made.bind()
    assert (made.image() == camera._renderer.image()).all()
    assert isinstance(made.chosen, RayRenderer)


def test_opengl_is_looked_for_in_processes_of_their_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(quicker_renderer, "PROBE", "import sys; print(sys.argv[1] == 'osmesa' and 'works')")
    search = OpenGlSearch()
    for _ in range(2):
        search.look()
        assert not search.done and search._process is not None
        search._process.wait(timeout=60)
    search.look()
    assert (search.done, search.backend, search._process) == (True, "osmesa", None)
    monkeypatch.setattr(quicker_renderer, "PROBE", "import time; time.sleep(1000)")
    search = OpenGlSearch()
    search.look()
    process = search._process
    assert process is not None
    search.end()
    assert process.returncode == -9


@pytest.mark.parametrize("size", [(160, 120), (33, 21)])
def test_a_fast_camera_shows_the_same_with_a_quarter_of_the_rays(load_text: Load, size: tuple[int, int]) -> None:
    width, height = size
    text = SCENE.replace(">160<", f">{width}<").replace(">120<", f">{height}<")
    whole = eye(load_text(text)).image().astype(int)
    fast = eye(load_text(text, render_engine="fast")).image().astype(int)
    assert fast.shape == whole.shape == (height, width, 3)
    assert (fast[0:-1:2, 0:-1:2] == fast[1::2, 1::2]).all()
    assert np.median(np.abs(fast - whole)) <= 1 and (np.abs(fast - whole).max(axis=2) > 40).mean() < 0.06
