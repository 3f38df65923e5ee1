"""Sensors: what they say, drawn where it is: scans in the world, pictures in the panel, contacts at the bodies.

A sensor that nobody hears does not measure, so a topic is subscribed to only while it is shown here.
"""

from __future__ import annotations

import threading
from typing import Any

import mujoco
import numpy as np
from mujoco.studio.dear_imgui import dear_imgui as imgui

from gz_course.sim.gz.msgs.image_pb2 import Image
from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan
from gz_course.sim.gz.view.sensor_drawings import pixels_of, rays_of
from gz_course.sim.gz.view.window import Window

_KINDS = {"gz.msgs.LaserScan": LaserScan, "gz.msgs.Image": Image}
_CONTACTS = {
    "contact points": mujoco.mjtVisFlag.mjVIS_CONTACTPOINT,
    "contact forces": mujoco.mjtVisFlag.mjVIS_CONTACTFORCE,
    "joints": mujoco.mjtVisFlag.mjVIS_JOINT,
    "centres of mass": mujoco.mjtVisFlag.mjVIS_COM,
    "inertias": mujoco.mjtVisFlag.mjVIS_INERTIA,
}


class Panel:
    """The second tab on the right."""

    TITLE = "Sensors"
    PLACE = "right"
    ORDER = 21

    def __init__(self, window: Window) -> None:
        self._window = window
        self.topics: dict[str, str] = {}
        """Type name by topic, of all that can be shown."""
        self.shown: set[str] = set()
        self._latest: dict[str, Any] = {}
        self._rays: dict[str, list[mujoco.MjvGeom]] = {}
        self._pictures: dict[str, tuple[int, int, int]] = {}
        """The texture and its size [pixels], by topic."""
        self._new: set[str] = set()
        self._closed = threading.Event()
        threading.Thread(target=self._search, daemon=True).start()

    def _search(self) -> None:
        while not self._closed.wait(0.3 if not self.topics else 3.0):
            self.topics = {t: kind for kind in _KINDS for t in self._window.link.topics_of(kind)}

    def show(self, topic: str, shown: bool) -> None:
        """Show or hide what a topic says."""
        node = self._window.link.node
        if shown and topic not in self.shown:
            self.shown.add(topic)
            node.subscribe(_KINDS[self.topics[topic]], topic, lambda message: self._take(topic, message))
        elif not shown and topic in self.shown:
            self.shown.discard(topic)
            node.unsubscribe(topic)
            self._latest.pop(topic, None)
            self._rays.pop(topic, None)

    def _take(self, topic: str, message: Any) -> None:
        self._latest[topic] = message
        self._new.add(topic)

    def build(self) -> None:
        imgui.SeparatorText("Visualize contacts")
        flags = self._window.viewer.vis_options.flags
        for label, flag in _CONTACTS.items():
            changed, on = imgui.Checkbox(label, bool(flags[int(flag)]))
            if changed:
                flags[int(flag)] = on
        imgui.SeparatorText("Visualize lidar, image display")
        if not self.topics:
            imgui.TextWrapped("no topic of gz.msgs.LaserScan or gz.msgs.Image yet")
        for topic, kind in list(self.topics.items()):
            changed, shown = imgui.Checkbox(topic, topic in self.shown)
            if changed:
                self.show(topic, shown)
            if shown and kind == "gz.msgs.Image":
                self._picture(topic)

    def _picture(self, topic: str) -> None:
        message = self._latest.get(topic)
        if message is not None and topic in self._new:
            self._new.discard(topic)
            pixels = pixels_of(message)
            if pixels is not None:
                height, width, _ = pixels.shape
                texture = self._pictures.get(topic, (0, 0, 0))[0]
                made = self._window.viewer.upload_image(texture, pixels.tobytes(), width, height, 3)
                self._pictures[topic] = (made, width, height)
        if topic in self._pictures:
            texture, width, height = self._pictures[topic]
            across = max(64.0, imgui.GetContentRegionAvail().x)
            imgui.Image(texture, imgui.Vec2(across, across * height / width))

    def geoms(self) -> list[mujoco.MjvGeom]:
        for topic in [each for each in self._new if self.topics.get(each) == "gz.msgs.LaserScan"]:
            self._new.discard(topic)
            message = self._latest.get(topic)
            if message is not None and topic in self.shown:
                self._rays[topic] = rays_of(message)
        return [geom for rays in self._rays.values() for geom in rays]

    def rays(self, topic: str) -> np.ndarray:
        """Return the ends [m] of the rays that are drawn for a topic, (n, 3)."""
        return np.array([geom.pos + geom.mat[:, 2] * geom.size[2] for geom in self._rays.get(topic, [])])

    def close(self) -> None:
        self._closed.set()
