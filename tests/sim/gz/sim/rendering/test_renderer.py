"""Render engines: accepted names, and agreement of the OpenGL images, if available, with the ray-cast ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.rendering import renderer
from gz_course.sim.gz.sim.rendering.renderer import GlRenderer, check_engine, gl_backend
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
