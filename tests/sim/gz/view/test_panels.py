"""The panels and the drag of the view, called directly: each does what it says to a running world."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest
from mujoco.studio.dear_imgui import dear_imgui as imgui

from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.physics.geoms import COLLISION_GROUP
from gz_course.sim.gz.view.entities import models_of
from gz_course.sim.gz.view.panels.world_control import times
from gz_course.tests.sim.gz.view.conftest import Shown, draw, eventually


def test_play_pause_step_and_reset_are_those_of_the_world(shown: Shown) -> None:
    shown.link.step(7)
    eventually(lambda: shown.link.stats.iterations == 7 and shown.link.stats.paused, "seven steps")
    shown.window.toggle_pause()
    eventually(lambda: not shown.server.paused, "it plays")
    eventually(lambda: not shown.link.stats.paused and shown.link.stats.iterations > 20, "and says so")
    shown.window.toggle_pause()
    eventually(lambda: shown.server.paused and shown.link.stats.paused, "it pauses")
    shown.link.reset()
    eventually(lambda: shown.world.iterations == 0 and shown.link.stats.iterations == 0, "it starts again")
    assert shown.server.paused, "a reset does not play"


def test_times_are_read_as_in_gazebo(shown: Shown) -> None:
    stats: Any = type(shown.link.stats)(real_time_factor=0.934, iterations=12)
    stats.sim_time.sec, stats.sim_time.nsec = 75, 5_000_000
    assert "real time factor 93 %   sim time 01:15.005" in times(stats)


def test_a_model_comes_and_goes(shown: Shown) -> None:
    spawner, tree = shown.window.panel("Resource spawner"), shown.window.panel("Entity tree")
    spawner.at_camera, spawner.place = False, [1.0, -1.5]
    spawner.insert_shape("box")
    shown.has("box")
    assert shown.world.truth.pose("box").position[:2] == pytest.approx((1.0, -1.5))
    spawner.place = [3.0, 2.0]
    assert "shelf" in spawner._models
    spawner.insert_model("shelf")
    shown.has("shelf")
    tree.click("box::link")
    assert shown.window.selected == shown.window.followed == "box::link"
    assert shown.viewer.model.body(shown.viewer.camera.trackbodyid).name == "box::link"
    tree.remove_selected()
    eventually(lambda: shown.window.entity("box") is None, "the box goes")
    assert "box" not in shown.world.model_names()
    left = shown.window
    eventually(lambda: not (left.selected or left.followed or shown.viewer.perturb.select), "nothing is selected")


def test_what_the_world_refuses_is_said(shown: Shown) -> None:
    shown.link.remove("nobody")
    eventually(lambda: "refused" in shown.link.said, "the refusal")
    assert shown.link.said == "remove 'nobody': refused; the terminal of gz sim says why"


def test_a_camera_that_follows_stays_with_its_link_when_models_change(shown: Shown) -> None:
    tree = shown.window.panel("Entity tree")
    tree.click("robot")
    shown.link.remove("crate")
    eventually(lambda: shown.window.entity("crate") is None, "the crate goes")
    camera = shown.viewer.camera
    eventually(lambda: shown.viewer.model.body(camera.trackbodyid).name == "robot::base_link", "it follows the robot")
    tree.click("pillar")
    assert shown.viewer.camera.trackbodyid == -1, "a static model has no body"
    assert shown.viewer.camera.lookat == pytest.approx(shown.window.models["pillar"].centre(shown.viewer.data))


def test_the_stick_drives_until_it_is_let_go(shown: Shown) -> None:
    heard: list[Any] = []
    shown.node.subscribe(Twist, "/model/robot/cmd_vel", heard.append)
    teleop = shown.window.panel("Teleop")
    eventually(lambda: teleop.topic == "/model/robot/cmd_vel", "the topic of the robot is found")
    eventually(lambda: teleop.drive(1.0, -0.5) or heard, "it drives")
    assert (heard[0].linear.x, heard[0].angular.z) == (0.5, -0.5)
    eventually(lambda: heard[-1].linear.x == 0.0, "without pictures of the page it stops")
    eventually(lambda: teleop.drive(2.0, 0.0) or heard[-1].linear.x == 0.5, "it drives again")
    teleop.drive(0.0, 0.0)
    eventually(lambda: heard[-1].linear.x == 0.0, "it stops when the stick is let go")
    shown.node.unsubscribe("/model/robot/cmd_vel")


def test_a_scan_is_drawn_where_it_hits(shown: Shown) -> None:
    sensors = shown.window.panel("Sensors")
    eventually(lambda: "/lidar/scan" in sensors.topics, "the topic of the lidar is found")
    assert sensors.geoms() == []
    sensors.show("/lidar/scan", True)
    shown.link.play()
    eventually(lambda: sensors.geoms(), "rays")
    ends = sensors.rays("/lidar/scan")
    assert 50 < len(ends) <= 240
    assert np.abs(ends[:, 0]).max() < 4.2 and np.abs(ends[:, 1]).max() < 3.2, "inside the room"
    assert ends[:, 0].min() == pytest.approx(-4.0, abs=0.1), "at the west wall"
    sensors.show("/lidar/scan", False)
    assert sensors.geoms() == []


def test_a_drag_pushes_a_running_world_and_moves_a_paused_one(shown: Shown) -> None:
    window, perturb = shown.window, shown.viewer.perturb
    dragging = window._dragging
    window.select("robot")
    perturb.active = int(mujoco.mjtPertBit.mjPERT_TRANSLATE)
    perturb.refpos[:] = shown.viewer.data.xipos[perturb.select] + (0.0, 1.0, 0.0)
    perturb.refselpos[:] = perturb.refpos
    perturb.refquat[:] = shown.viewer.data.xquat[perturb.select]
    perturb.scale = perturb.localmass = 1.0
    before = shown.world.truth.pose("robot").position
    dragging.update(shown.viewer.model, shown.viewer.data, perturb, np.zeros(3), paused=True)
    eventually(lambda: shown.world.truth.pose("robot").position[1] > before[1] + 0.5, "it is elsewhere")

    sent: list[Any] = []
    shown.link.drag = lambda link, push: sent.append((link, push.copy()))  # type: ignore[method-assign]
    dragging._next = 0.0
    dragging.update(shown.viewer.model, shown.viewer.data, perturb, np.zeros(3), paused=False)
    perturb.active = 0
    dragging.update(shown.viewer.model, shown.viewer.data, perturb, np.zeros(3), paused=False)
    del shown.link.drag  # type: ignore[method-assign]
    (link, push), (_, end) = sent
    assert link == "robot::base_link" and push[1] > 0.1
    assert not end.any(), "let go"
    window.select("")


def test_collisions_are_shown_on_demand(shown: Shown) -> None:
    panel = shown.window.panel("View")
    assert not shown.viewer.vis_options.geomgroup[COLLISION_GROUP]
    panel.show(COLLISION_GROUP, True)
    assert shown.viewer.vis_options.geomgroup[COLLISION_GROUP]
    assert len(panel.geoms()) == 42
    panel.grid = False
    assert panel.geoms() == []
    panel.grid = True


def test_the_tree_has_static_models_and_all_links(shown: Shown) -> None:
    found = models_of(shown.world.model)
    assert list(found)[:2] == ["robot", "ground_plane"]
    assert "robot::lidar_link" in found["robot"].links and len(found["robot"].bodies) == 6
    assert found["pillar"].bodies == [] and len(found["pillar"].geoms) == 2


def test_every_panel_is_drawn(shown: Shown, pictures: None) -> None:
    window = shown.window
    window.select("robot::lidar_link")
    titles = [panel.TITLE for panel in window.panels]
    for title in titles:
        window.hidden = {each for each in titles if each not in (title, "World control")}
        for _ in range(3):
            draw(window)
        assert title not in window.hidden, shown.link.said
    window.hidden.clear()
    assert len(shown.viewer.extra_geoms) == 42, "the grid"
    window.select("")


@pytest.mark.parametrize(
    ("width", "height", "kept"), [(1280, 800, {"Entity tree", "Teleop"}), (520, 780, {"Teleop"}), (680, 520, set())]
)
def test_a_narrow_page_keeps_the_stick_if_it_is_tall(
    shown: Shown, pictures: None, width: int, height: int, kept: set[str]
) -> None:
    window = shown.window
    window._laid_out, window.hidden = (0.0, 0.0), set()
    imgui.GetIO().DisplaySize = imgui.Vec2(width, height)
    drawn = {}
    teleop = window.panel("Teleop")
    build = teleop.build
    teleop.build = lambda: (drawn.update(at=imgui.GetCursorScreenPos().y), build())
    for _ in range(3):
        draw(window)
    del teleop.build
    assert {"Entity tree", "Teleop"} - window.hidden == kept
    assert bool(drawn) == ("Teleop" in kept)
    if kept == {"Teleop"}:
        assert drawn["at"] > 0.4 * height, "the stick is below the picture"
    window.hidden.clear()


def test_a_panel_that_breaks_down_is_closed(shown: Shown, pictures: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shown.window.panel("Entity tree"), "build", lambda: [][1])

    def is_told() -> bool:
        shown.window.hidden.clear()
        draw(shown.window)
        draw(shown.window)
        return shown.link.said == "panel 'Entity tree' is closed: IndexError: list index out of range"

    eventually(is_told, "the sentence, which a late answer to an earlier request may replace")
    assert shown.window.hidden == {"Entity tree"}
    shown.window.hidden.clear()
