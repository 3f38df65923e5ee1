"""The keys of the view and its text: each key does what the list says, and what happens is said once."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from mujoco.studio.dear_imgui import dear_imgui as imgui

from gz_course.sim.gz.view import keyboard
from gz_course.sim.gz.view.description import Description
from gz_course.sim.gz.view.keys import KEYS
from gz_course.tests.sim.gz.view.conftest import Shown, draw, eventually


@pytest.fixture
def press(shown: Shown, pictures: None, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Press a key, or hold it, for one picture."""

    def one(chord: str) -> None:
        monkeypatch.setattr(imgui, "IsKeyChordPressed", lambda code: code == keyboard._code(chord))
        monkeypatch.setattr(keyboard, "_is_held", lambda other: other == chord)
        draw(shown.window)
        monkeypatch.setattr(imgui, "IsKeyChordPressed", lambda code: False)
        monkeypatch.setattr(keyboard, "_is_held", lambda other: False)
        draw(shown.window)

    return one


def test_every_key_does_what_the_list_says(shown: Shown, press: Callable[[str], None]) -> None:
    window, link, camera = shown.window, shown.link, shown.viewer.camera
    press("Home")
    press("N")
    eventually(lambda: link.stats.iterations == 1, "a step")
    press("Space")
    eventually(lambda: not link.paused and not shown.server.paused, "it plays")
    press("N")
    assert link.said == "step: pause the world first, with Space"
    press("Space")
    eventually(lambda: shown.server.paused, "it pauses")
    press("Backspace")
    eventually(lambda: shown.world.iterations == 0, "it starts again")

    press("E")
    assert window.selected == next(iter(window.models)) == "robot"
    press("F")
    assert window.followed == "robot"
    press("F")
    assert window.followed == ""
    before = shown.world.truth.pose("robot").position
    draw(window)
    press("Shift+LeftArrow")
    eventually(lambda: shown.world.truth.pose("robot").position[1] > before[1] + 0.01, "it is moved to the left")
    press("Shift+E")
    assert window.selected == list(window.models)[-1]
    press("Shift+UpArrow")
    assert link.said == "push: select a model that can move first, with E"
    last = window.selected
    press("Delete")
    eventually(lambda: window.entity(last) is None, "it is removed")
    eventually(lambda: not window.selected, "nothing is selected")

    press("Home")
    where = camera.azimuth, camera.elevation, camera.distance, *camera.lookat
    for key in ("J", "I", "PageUp", "Shift+I"):
        press(key)
    assert camera.azimuth < where[0] and camera.elevation < where[1] and camera.distance < where[2]
    assert camera.lookat[0] > where[3]
    press("Home")
    assert (camera.azimuth, camera.elevation, camera.distance, *camera.lookat) == where
    window.hidden.add("Keys")
    press("H")
    assert "Keys" not in window.hidden


def test_keys_lead_into_the_panels_and_out_again(shown: Shown, press: Callable[[str], None]) -> None:
    press("F2")
    assert shown.link.said.startswith("panel World control:")
    eventually(lambda: draw(shown.window) or imgui.GetIO().WantCaptureKeyboard, "the panel takes the keys")
    press("Backspace")
    assert shown.link.said.startswith("panel World control:"), "other keys are those of the panel"
    press("F2")
    assert shown.link.said.startswith("panel Entity tree:")
    press("Escape")
    eventually(lambda: draw(shown.window) or not imgui.GetIO().WantCaptureKeyboard, "the world has the keys")


def test_every_action_is_there_and_no_key_is_taken_twice() -> None:
    chords = [chord for key in KEYS for chord in key.chords]
    assert len(chords) == len(set(chords)) and not {"W", "A", "S", "D"} & set(chords)
    assert all(callable(getattr(keyboard.Keyboard, key.action)) for key in KEYS if key.action)


def test_what_is_spoken_changes_when_something_else_happens(shown: Shown, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gz_course.sim.gz.view.description._PERIOD_S", 0.0)
    told, window = Description(), shown.window
    shown.link.said = "world 'lidar_room'"
    told.update(window)
    first = told.spoken.strip()
    assert first == "World lidar_room, paused. robot stands at x -2.0, y 0.0 metres, heading 0 degrees."
    assert "Simulated time 0 seconds. robot stands at x -2.00, y 0.00, z 0.05 metres" in told.whole
    assert "cannot move: ground_plane, wall_south" in told.whole
    body = window.models["robot"].bodies[0]
    said = []
    for step in range(4):
        window.data.xpos[body, 0] += 0.1 * (step < 3)
        told.update(window)
        said.append(told.spoken.strip())
    assert said[:3] == ["World lidar_room, paused. robot moves."] * 3, "one sentence for the whole way"
    assert said[3] == first.replace("-2.0", "-1.7")
    window.select("crate")
    told.update(window)
    assert told.spoken.strip().endswith("crate is selected.")
    window.select("")


def test_a_reader_who_wants_motion_reduced_is_not_taken_along(shown: Shown) -> None:
    tree = shown.window.panel("Entity tree")
    assert tree.follows
    shown.window.told(True)
    assert not tree.follows
    tree.follows = True
    shown.window.told(True)
    assert tree.follows, "who asks for it has it"
    shown.window.told(False)
