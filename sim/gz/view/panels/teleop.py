"""Teleop: drive a robot with keys or a joystick pad; publishes a gz.msgs.Twist on a chosen topic.

While something is pressed the Twist is published ten times per second. When it is let go, when the page is closed or
hidden, and when the panel is closed, one Twist of zeros follows.
"""

from __future__ import annotations

import math
import threading
import time
from typing import Any

import mujoco
from mujoco.studio.dear_imgui import dear_imgui as imgui

from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.view.window import Window

PERIOD_S = 0.1
"""Time [s] between two Twists."""
_SILENCE_S = 0.6
"""Time [s] without a picture after which the page counts as closed."""
_PAD = 150.0
"""Width of the joystick pad [pixels]."""
_BACK, _KNOB = (0.75, 0.78, 0.82, 1.0), (0.13, 0.35, 0.7, 1.0)
_KEYS = {
    (1.0, 0.0): (imgui.Key.UpArrow, imgui.Key.W),
    (-1.0, 0.0): (imgui.Key.DownArrow, imgui.Key.S),
    (0.0, 1.0): (imgui.Key.LeftArrow, imgui.Key.A),
    (0.0, -1.0): (imgui.Key.RightArrow, imgui.Key.D),
}


class Panel:
    """The first tab on the right; `drive` may be called from any thread."""

    TITLE = "Teleop"
    PLACE = "right"
    ORDER = 20

    def __init__(self, window: Window) -> None:
        self._window = window
        self.topics: list[str] = []
        self.topic = ""
        self.forward, self.turn = 0.5, 1.0
        """Largest velocities: ahead [m/s] and to the left [rad/s]."""
        self.keys = True
        """Whether the keys drive; otherwise they are Studio's."""
        self._publishers: dict[str, Any] = {}
        self._stick = (0.0, 0.0)
        self._seen = 0.0
        self._moves = threading.Event()
        self._closed = threading.Event()
        threading.Thread(target=self._publish, daemon=True).start()
        threading.Thread(target=self._search, daemon=True).start()

    def drive(self, ahead: float, left: float) -> None:
        """Hold the stick there, from -1 to 1 in both directions, until the next call or until no picture comes."""
        self._stick = (max(-1.0, min(1.0, ahead)), max(-1.0, min(1.0, left)))
        self._seen = time.monotonic()
        if any(self._stick):
            self._moves.set()

    def _publish(self) -> None:
        """Publish while the stick is held; the last Twist is zero."""
        moving = ""
        while not self._closed.is_set():
            self._moves.wait()
            held = self._stick if time.monotonic() - self._seen < _SILENCE_S else (0.0, 0.0)
            topic = self.topic
            if moving and (topic != moving or not any(held)):
                self._send(moving, 0.0, 0.0)
                moving = ""
            if any(held) and topic and not self._closed.is_set():
                self._send(topic, *held)
                moving = topic
                self._closed.wait(PERIOD_S)
            else:
                self._moves.clear()
        if moving:
            self._send(moving, 0.0, 0.0)

    def _send(self, topic: str, ahead: float, left: float) -> None:
        publisher = self._publishers.get(topic)
        if publisher is None:
            publisher = self._publishers[topic] = self._window.link.node.advertise(topic, Twist)
            publisher.wait_for_subscribers(1, 1.0)
        message: Any = Twist()
        message.linear.x, message.angular.z = ahead * self.forward, left * self.turn
        publisher.publish(message)

    def _search(self) -> None:
        """Look for topics of Twists every few seconds; choose the first one that a robot hears."""
        while not self._closed.wait(0.2 if not self.topics else 3.0):
            self.topics = self._window.link.topics_of("gz.msgs.Twist")
            if not self.topic and self.topics:
                self.topic = self.topics[0]

    def build(self) -> None:
        imgui.TextUnformatted("Twist on topic:")
        imgui.SetNextItemWidth(-1.0)
        if imgui.BeginCombo("##topic", self.topic or "no topic of gz.msgs.Twist yet"):
            for each in self.topics:
                if imgui.Selectable(each, each == self.topic):
                    self.topic = each
            imgui.EndCombo()
        imgui.TextUnformatted("or another topic:")
        imgui.SetNextItemWidth(-1.0)
        typed, topic = imgui.InputText("##other", self.topic)
        if typed:
            self.topic = topic.strip()
        imgui.SetNextItemWidth(140.0)
        _, self.forward = imgui.SliderFloat("m/s", self.forward, 0.0, 2.0, "%.2f")
        imgui.SetNextItemWidth(140.0)
        _, self.turn = imgui.SliderFloat("rad/s", self.turn, 0.0, 3.0, "%.2f")
        _, self.keys = imgui.Checkbox("Keyboard (arrows, WASD)", self.keys)
        stick = self._pad()
        if stick == (0.0, 0.0) and self.keys and not imgui.GetIO().WantCaptureKeyboard:
            stick = self._held_keys()
        self.drive(*stick)

    def _held_keys(self) -> tuple[float, float]:
        ahead = left = 0.0
        if imgui.GetIO().KeyShift:
            return 0.0, 0.0
        for (forward, turn), keys in _KEYS.items():
            if any(imgui.IsKeyDown(key) for key in keys):
                ahead, left = ahead + forward, left + turn
        return ahead, left

    def _pad(self) -> tuple[float, float]:
        """Draw the joystick pad; return where it is held."""
        corner = imgui.GetCursorScreenPos()
        imgui.InvisibleButton("pad", imgui.Vec2(_PAD, _PAD))
        held = imgui.IsItemActive()
        radius = _PAD / 2.0
        middle = imgui.Vec2(corner.x + radius, corner.y + radius)
        across = up = 0.0
        if held:
            mouse = imgui.GetMousePos()
            across, up = (mouse.x - middle.x) / radius, (middle.y - mouse.y) / radius
            length = max(1.0, math.hypot(across, up))
            across, up = across / length, up / length
        drawing = imgui.GetWindowDrawList()
        back, knob = (imgui.ColorConvertFloat4ToU32(imgui.Vec4(*colour)) for colour in (_BACK, _KNOB))
        drawing.AddCircleFilled(middle, radius, back)
        drawing.AddCircleFilled(imgui.Vec2(middle.x + across * radius, middle.y - up * radius), 14.0, knob)
        return (up, -across) if held else (0.0, 0.0)

    def geoms(self) -> list[mujoco.MjvGeom]:
        return []

    def close(self) -> None:
        self._closed.set()
        self._moves.set()
