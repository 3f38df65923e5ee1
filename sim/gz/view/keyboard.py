"""What the keys of `keys.py` do to the window, its camera and its world."""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np
from mujoco.studio.dear_imgui import dear_imgui as imgui

from gz_course.sim.gz.view.keys import ALWAYS, KEYS

if TYPE_CHECKING:
    from gz_course.sim.gz.view.window import Window

_DEGREES, _LENGTHS = 60.0, 0.8
"""Speeds of the camera: angle [degrees/s], and part of its distance per second."""
_LONGEST_S = 0.1
"""Time [s] between two pictures that the camera moves for at most."""
_STEEPEST = 89.0
"""Angle [degrees] of the camera from the horizontal at most."""
_NEAREST, _FURTHEST = 0.1, 200.0
"""Distances [m] of the camera from what it looks at."""
_AHEAD_AND_LEFT = ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))


class Keyboard:
    """The keys of one window; `push` is where the selected model shall go."""

    def __init__(self, window: Window) -> None:
        self._window = window
        self.in_panels = False
        """Whether the keys go to the panels."""
        self.push_along = np.zeros(3)
        """Direction x, y and turn to the left, each from -1 to 1."""

    def update(self) -> None:
        """Obey the keys of this picture."""
        self.push_along[:] = 0.0
        taken = imgui.GetIO().WantCaptureKeyboard
        for key in KEYS:
            for number, chord in enumerate(key.chords):
                if taken and not (key.action in ALWAYS and len(chord) > 1):
                    continue
                code = _code(chord)
                if key.held:
                    if _is_held(chord):
                        getattr(self, key.action)(number)
                elif imgui.IsKeyChordPressed(code):
                    getattr(self, key.action)(number)

    def toggle_pause(self, _: int) -> None:
        self._window.toggle_pause()

    def step(self, _: int) -> None:
        if self._window.link.paused:
            self._window.link.step(self._window.panel("World control").steps)
        else:
            self._window.link.said = "step: pause the world first, with Space"

    def reset(self, _: int) -> None:
        self._window.link.reset()

    def select(self, backwards: int) -> None:
        names = list(self._window.models)
        if not names:
            return
        now = self._window.selected.split("::", 1)[0]
        step = -1 if backwards else 1
        at = names.index(now) + step if now in names else min(0, step)
        self._window.select(names[at % len(names)])

    def follow(self, _: int) -> None:
        window = self._window
        if not window.selected and not window.followed:
            window.link.said = "follow: select a model first, with E"
        window.follow("" if window.followed else window.selected)

    def remove(self, _: int) -> None:
        if self._window.selected:
            self._window.link.remove(self._window.selected.split("::", 1)[0])
        else:
            self._window.link.said = "remove: select a model first, with E"

    def push(self, number: int) -> None:
        if not self._window.viewer.perturb.select:
            self._window.link.said = "push: select a model that can move first, with E"
        elif number < len(_AHEAD_AND_LEFT):
            self.push_along[:2] += _AHEAD_AND_LEFT[number]
        else:
            self.push_along[2] += 1.0 if number == len(_AHEAD_AND_LEFT) else -1.0

    def turn(self, number: int) -> None:
        camera, (up, left) = self._window.viewer.camera, _AHEAD_AND_LEFT[number]
        camera.azimuth -= left * _DEGREES * _passed()
        lower = camera.elevation - up * _DEGREES * _passed()
        camera.elevation = min(_STEEPEST, max(-_STEEPEST, lower))

    def pan(self, number: int) -> None:
        window, (ahead, left) = self._window, _AHEAD_AND_LEFT[number]
        camera = window.viewer.camera
        if camera.type == int(mujoco.mjtCamera.mjCAMERA_TRACKING):
            window.follow("")
        angle, far = np.radians(camera.azimuth), camera.distance * _LENGTHS * _passed()
        camera.lookat[0] += far * (ahead * np.cos(angle) - left * np.sin(angle))
        camera.lookat[1] += far * (ahead * np.sin(angle) + left * np.cos(angle))

    def zoom(self, further: int) -> None:
        camera = self._window.viewer.camera
        change = 1.0 + (_LENGTHS if further else -_LENGTHS) * _passed()
        camera.distance = min(_FURTHEST, max(_NEAREST, camera.distance * change))

    def look_at_all(self, _: int) -> None:
        self._window.look_at_all()

    def show_keys(self, _: int) -> None:
        self._window.show_panel("Keys")

    def enter_panels(self, _: int) -> None:
        """Let the keys go to a panel, or to the next one."""
        window = self._window
        shown = [panel.TITLE for panel in window.panels if panel.TITLE not in window.hidden]
        self._panel = (self._panel + 1) % len(shown) if self.in_panels else 0
        self.in_panels = True
        _let_keys_move_focus(True)
        imgui.SetWindowFocus(shown[self._panel])
        window.link.said = f"panel {shown[self._panel]}: arrows choose, Space presses, F2 the next panel, Escape back"

    _panel = 0

    def leave(self, _: int) -> None:
        if self.in_panels:
            self.in_panels = False
            _let_keys_move_focus(False)
            imgui.SetWindowFocus(None)
            self._window.link.said = "the keys are those of the world again"
        else:
            self._window.select("")
            self._window.follow("")


def _let_keys_move_focus(on: bool) -> None:
    io, flag = imgui.GetIO(), int(imgui.ConfigFlags.NavEnableKeyboard)
    io.ConfigFlags = int(io.ConfigFlags) | flag if on else int(io.ConfigFlags) & ~flag


def _code(chord: str) -> int:
    return sum(int(getattr(imgui.Key, each)) for each in chord.split("+"))


def _is_held(chord: str) -> bool:
    *shift, key = chord.split("+")
    io = imgui.GetIO()
    return bool(io.KeyShift) == bool(shift) and not io.KeyCtrl and bool(imgui.IsKeyDown(getattr(imgui.Key, key)))


def _passed() -> float:
    return min(_LONGEST_S, float(imgui.GetIO().DeltaTime))
