"""The robots that a launch has created, as `grader/kinds/launch/robot_facts.py` recorded them.

Places and directions are in the frame of the model: x points ahead, z points up, lengths are in [m].
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from gz_course.grader.record.reading import Recording
from gz_course.grader.score.launched import launch_facts

LUMPED = re.compile(r"_fixed_joint_lump__(.+?)_collision(?:_\d+)?$")
LEVEL = 0.002  # [m] by which points that touch the ground at the same time may differ in height


@dataclass(frozen=True)
class Shape:
    """One collision: `size` is its full extent along its own axes, `mu` its friction."""

    kind: str
    size: np.ndarray
    position: np.ndarray
    rotation: np.ndarray
    mu: float | None
    name: str = ""

    @property
    def part(self) -> str:
        """The link of a URDF that it belongs to, if that was lumped into another; else empty."""
        found = LUMPED.search(self.name)
        return found[1] if found else ""

    @property
    def axle(self) -> np.ndarray:
        """The direction of a cylinder's own axis."""
        return np.asarray(self.rotation[:, 2])

    def corners(self) -> np.ndarray:
        """Return the points (n, 3) of the shape that can be its lowest ones."""
        if self.kind == "sphere":
            return np.asarray([self.position - [0.0, 0.0, self.size[0] / 2]])
        if self.kind in ("cylinder", "capsule"):
            down = np.array([0.0, 0.0, -1.0])
            aside = down - self.axle * (down @ self.axle)
            length = float(np.linalg.norm(aside))
            reach, radius = self.axle * self.size[2] / 2, self.size[0] / 2
            around = [aside / length] if length > 1e-3 else [*self.rotation[:, :2].T, *-self.rotation[:, :2].T]
            return np.array([self.position + end * reach + radius * each for end in (-1, 1) for each in around])
        signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
        return np.asarray(self.position + (signs * self.size / 2) @ self.rotation.T)


@dataclass(frozen=True)
class Link:
    """A rigid body with its collisions."""

    name: str
    mass: float
    centre: np.ndarray  # of mass
    shapes: tuple[Shape, ...]

    @property
    def lowest(self) -> float:
        """Height of its lowest point; infinite if it has no collision."""
        return min((float(shape.corners()[:, 2].min()) for shape in self.shapes), default=np.inf)

    @property
    def lowest_part(self) -> str:
        """The name of what reaches lowest: the link of a URDF that was lumped into this one, or this link itself."""
        low = min(self.shapes, key=lambda shape: float(shape.corners()[:, 2].min()), default=None)
        return (low.part if low is not None else "") or self.name


@dataclass(frozen=True)
class Joint:
    """A joint: `axis` in the frame of the model, `stated` in the frame of the joint. None stands for no limit."""

    name: str
    kind: str
    child: str
    position: np.ndarray
    axis: np.ndarray | None = None
    stated: np.ndarray | None = None
    lower: float | None = None
    upper: float | None = None
    effort: float | None = None
    velocity: float | None = None
    damping: float = 0.0


@dataclass(frozen=True)
class Settings:
    """The elements below a sensor or a plugin: pairs of path and text."""

    values: tuple[tuple[str, str], ...]

    def all(self, path: str) -> list[str]:
        return [text for name, text in self.values if name == path]

    def text(self, path: str, default: str = "") -> str:
        return next(iter(self.all(path)), default)

    def number(self, path: str, default: float) -> float:
        try:
            return float(self.text(path, str(default)))
        except ValueError:
            return default


@dataclass(frozen=True)
class Sensor(Settings):
    """A sensor of a link; `up` is its z axis."""

    name: str = ""
    kind: str = ""
    link: str = ""
    position: np.ndarray = field(default_factory=lambda: np.zeros(3))
    up: np.ndarray = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))


@dataclass(frozen=True)
class Plugin(Settings):
    """A system that the robot asks for."""

    name: str = ""
    filename: str = ""

    def is_a(self, system: str) -> bool:
        return self.name.rpartition("::")[2] == system


@dataclass(frozen=True)
class Robot:
    """A model with all its parts."""

    name: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    sensors: tuple[Sensor, ...]
    plugins: tuple[Plugin, ...]

    def link(self, name: str) -> Link | None:
        return next((link for link in self.links if link.name == name), None)

    def joint(self, name: str) -> Joint | None:
        return next((joint for joint in self.joints if joint.name == name), None)

    def systems(self, system: str) -> list[Plugin]:
        """Return the plugins of a system, such as `DiffDrive`."""
        return [plugin for plugin in self.plugins if plugin.is_a(system)]

    def shapes(self) -> Iterator[tuple[Link, Shape]]:
        for link in self.links:
            for shape in link.shapes:
                yield link, shape

    @property
    def mass(self) -> float:
        return sum(link.mass for link in self.links)

    @property
    def centre(self) -> np.ndarray:
        """The centre of mass of all links."""
        return np.asarray(sum(link.mass * link.centre for link in self.links) / self.mass)

    def lowest_link(self) -> Link | None:
        """Return the link that reaches lowest; None if nothing can collide."""
        low = min(self.links, key=lambda link: link.lowest, default=None)
        return low if low is not None and np.isfinite(low.lowest) else None


def robot_of(recording: Recording, name: str) -> Robot | None:
    """Return a robot that the launch has created; None if there was none of that name, or not all of it is known."""
    raw = launch_facts(recording).get("robots", {}).get(name)
    if raw is None or not raw.get("complete") or not raw["links"]:
        return None
    return Robot(
        name,
        tuple(_link(each) for each in raw["links"]),
        tuple(_joint(each) for each in raw["joints"]),
        tuple(
            Sensor(_pairs(s), s["name"], s["kind"], s["link"], _array(s["position"]), _array(s["up"]))
            for s in raw["sensors"]
        ),
        tuple(Plugin(_pairs(p), p["name"], p["filename"]) for p in raw["plugins"]),
    )


def _array(values: Any) -> np.ndarray:
    return np.asarray(values, dtype=float)


def _pairs(raw: dict[str, Any]) -> tuple[tuple[str, str], ...]:
    return tuple((path, text) for path, text in raw["values"])


def _link(raw: dict[str, Any]) -> Link:
    shapes = tuple(
        Shape(s["kind"], _array(s["size"]), _array(s["position"]), _array(s["rotation"]), s["mu"], s["name"])
        for s in raw["shapes"]
    )
    return Link(raw["name"], raw["mass"], _array(raw["centre"]), shapes)


def _joint(raw: dict[str, Any]) -> Joint:
    axis, stated = (_array(raw[key]) if key in raw else None for key in ("axis", "stated_axis"))
    limits = {key: raw.get(key) for key in ("lower", "upper", "effort", "velocity")}
    place, damping = _array(raw["position"]), raw.get("damping") or 0.0
    return Joint(raw["name"], raw["kind"], raw["child"], place, axis, stated, **limits, damping=damping)
