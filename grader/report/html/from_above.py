"""The world at one moment, drawn from above as SVG: obstacles, robot, its path so far, its lidar scan.

Used by `page.py`. The x axis points right and the y axis up, as on a map.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup, escape

from gz_course.grader.record.bodies import Body, bodies, chain_of, hull, placed
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.steps import told

WIDEST = 40.0  # [m] of a larger world only the surroundings of the path are drawn
MARGIN = 1.5  # [m] around the path if only its surroundings are drawn
FOOT = 20  # [pixels] below the world, for the scale bar
ARROW = 0.35  # [m] length of the arrow that shows the robot's heading
FAR = 1e5  # [pixels] coordinates are clipped to this
MOST_POINTS = 360  # of a scan
MOST_CORNERS = 600  # of a path


@dataclass(frozen=True)
class View:
    """The drawn part of the world [m]."""

    left: float
    bottom: float
    right: float
    top: float


class Map:
    """The world of one recording, which can be drawn at any of its moments."""

    def __init__(self, recording: Recording, robot: str) -> None:
        self.recording = recording
        self.robot = robot
        every = bodies(recording)
        shapes = [(body, hull(body.at(0)[:, :2])) for body in every if not body.moves]
        self._standing = sorted(((b, h) for b, h in shapes if len(h) > 2), key=lambda pair: -_area(pair[1]))
        self.moving = sorted((body for body in every if body.moves), key=lambda body: body.at(0)[:, 2].max())
        self.scans = [(entity, chain_of(recording, entity)) for entity in recording.entities("world", "Points3D:pos")]
        self._x, self._y = (recording.signal(f"truth/{robot}/{axis}") for axis in "xy")
        self._yaw = recording.signal(f"truth/{robot}/yaw")
        self.view = self._look()

    def __bool__(self) -> bool:
        """Return whether there is anything to draw."""
        return bool(len(self._x) or self._standing or self.moving)

    def draw(self, time_s: float, width: int, alt: str, *, whole_path: bool = False) -> Markup:
        """Return the world at a simulated time [s] as an SVG element `width` pixels wide.

        `whole_path`: draw the path to its end instead of to this moment, and mark its start.
        """
        view, now = self.view, round(time_s * 1e9)
        scale = width / (view.right - view.left)
        height = scale * (view.top - view.bottom)

        def spots(points: np.ndarray) -> list[tuple[float, float]]:
            flat = points[:, :2].tolist()
            return [(_pixels((x - view.left) * scale), _pixels((view.top - y) * scale)) for x, y in flat]

        below = height + FOOT
        box = f"0 0 {width} {below:.0f}"
        parts = [f'<svg class="map" viewBox="{box}" role="img" aria-label="{escape(alt)}">']
        parts.append(f'<rect class="floor" width="{width}" height="{below:.0f}"/>')
        for body, outline in self._standing:
            parts.append(_polygon(body, spots(outline)))
        path = np.stack([self._x.values, self._y.values], axis=1)
        until = len(path) if whole_path else int(np.searchsorted(self._x.times, now, side="right"))
        corners = spots(_thinned(path[:until])) if until > 1 else []
        parts.append(f'<polyline class="path" points="{_joined(corners)}"/>')
        parts.append('<g class="moving">')
        for body in self.moving:
            parts.append(_polygon(body, spots(hull(body.at(now)[:, :2]))))
        parts.append("</g>")
        for entity, chain in self.scans:
            cloud = placed(self.recording.points_at(entity, now), chain, now)
            dots = "".join(f"M{x:.1f} {y:.1f}h0" for x, y in spots(cloud[:: len(cloud) // MOST_POINTS + 1]))
            parts.append(f'<path class="scan" d="{dots}"/>')
        parts.append(self._heading(now, scale))
        if whole_path and len(path):
            x, y = spots(path[:1])[0]
            parts.append(f'<circle class="start" cx="{x:.1f}" cy="{y:.1f}" r="6"/>')
            anchor = "end" if x > width / 2 else "start"
            parts.append(f'<text class="tick" x="{x:.1f}" y="{y - 10:.1f}" text-anchor="{anchor}">start</text>')
        parts.append(_ruler(scale, width, below))
        return Markup("".join([*parts, "</svg>"]))

    def told(self) -> str:
        if not len(self._x):
            return "The world seen from above."
        (x0, x1), (y0, y1) = ((s.values[0], s.values[-1]) for s in (self._x, self._y))
        distance = self.recording.signal(f"truth/{self.robot}/distance").values
        return (
            f"Seen from above: the robot goes from x = {told(x0)} m, y = {told(y0)} m to x = {told(x1)} m, "
            f"y = {told(y1)} m, {told(distance[-1] if len(distance) else 0.0)} m in all."
        )

    def where(self, time_s: float) -> str:
        """Return the robot's pose at a simulated time [s] in words."""
        index = int(np.searchsorted(self._x.times, round(time_s * 1e9), side="right")) - 1
        if not len(self._x):
            return ""
        x, y, yaw = (float(s.values[max(index, 0)]) for s in (self._x, self._y, self._yaw))
        return f"x = {told(x)} m, y = {told(y)} m, heading {round(math.degrees(yaw)) if math.isfinite(yaw) else 0}°"

    def _look(self) -> View:
        path = np.stack([self._x.values, self._y.values], axis=1)
        path = path[np.isfinite(path).all(axis=1) & (np.abs(path).max(axis=1, initial=0.0) < 1e6)]
        outlines = [outline for _, outline in self._standing]
        outlines += [body.at(0)[:, :2] for body in self.moving]
        world = np.concatenate([*outlines, np.zeros((1, 2))] if not len(path) else [*outlines, path])
        if max(np.ptp(world, axis=0)) <= WIDEST or not len(path):
            margin = 0.3
        else:
            world, margin = path, MARGIN
        (left, bottom), (right, top) = world.min(axis=0) - margin, world.max(axis=0) + margin
        # Limit the aspect ratio, because it stands beside other drawings.
        grow = max((right - left) * 0.5 - (top - bottom), 0.0) / 2, max((top - bottom) * 0.8 - (right - left), 0.0) / 2
        return View(left - grow[1], bottom - grow[0], right + grow[1], top + grow[0])

    def _heading(self, now: int, scale: float) -> str:
        """Return an arrow from the robot in the direction of its heading."""
        if not len(self._x) or not len(self._yaw):
            return ""
        index = max(int(np.searchsorted(self._x.times, now, side="right")) - 1, 0)
        x, y, yaw = (float(s.values[index]) for s in (self._x, self._y, self._yaw))
        px, py = _pixels((x - self.view.left) * scale), _pixels((self.view.top - y) * scale)
        length = max(ARROW * scale, 14.0)
        dx, dy = length * math.cos(yaw), -length * math.sin(yaw)
        tip = f"{px + dx:.1f} {py + dy:.1f}"
        left, right = (f"{px + 0.7 * dx + s * dy:.1f} {py + 0.7 * dy - s * dx:.1f}" for s in (0.25, -0.25))
        return f'<path class="heading" d="M{px:.1f} {py:.1f}L{tip}M{left}L{tip}L{right}"/>'


def _pixels(value: float) -> float:
    """Clip a coordinate [pixels], because a robot may be thrown arbitrarily far."""
    return min(max(value, -FAR), FAR) if math.isfinite(value) else FAR


def _polygon(body: Body, corners: list[tuple[float, float]]) -> str:
    red, green, blue, alpha = body.rgba
    fill = f'fill="#{red:02x}{green:02x}{blue:02x}" fill-opacity="{max(alpha / 255, 0.3):.2f}"'
    return f'<polygon class="body" {fill} points="{_joined(corners)}"/>'


def _joined(corners: Sequence[tuple[float, float]]) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)


def _thinned(path: np.ndarray) -> np.ndarray:
    step = len(path) // MOST_CORNERS + 1
    return np.concatenate([path[:-1:step], path[-1:]])


def _area(outline: np.ndarray) -> float:
    x, y = outline.T
    return abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))) / 2


def _ruler(scale: float, width: float, height: float) -> str:
    """Return a scale bar of a round length."""
    length = next((m for m in (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0) if m * scale > 0.12 * width), 50.0)
    x, y = 10.0, height - 8.0
    right = x + length * scale
    line = f'<path class="ruler" d="M{x:.1f} {y - 4:.1f}V{y:.1f}H{right:.1f}V{y - 4:.1f}"/>'
    return f'{line}<text class="tick" x="{right + 6:.1f}" y="{y:.1f}">{length:g} m</text>'
