"""How `gz sdf -p` writes numbers: angles in degrees, snapped angles, fewer digits; and the statistics of the inertia.

Source: https://github.com/gazebosim/sdformat/blob/sdf14/src/cmd/cmdsdformat.rb.in
Source: https://github.com/gazebosim/sdformat/blob/sdf14/src/PrintConfig.cc (snapping)
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gz_course.sim.gz.sim.pose import matrix
from gz_course.sim.gz.sim.sdf.description import Model
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.inertia import is_automatic, point_inertia, tensor

_EXACT = 17
_REAL = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


@dataclass(frozen=True)
class Numbers:
    """How numbers are written: `degrees` and `snap` [deg] change the angles of poses, `digits` 0 keeps all."""

    degrees: bool = False
    snap: int = 0
    tolerance: float = 0.01
    digits: int = 0

    def rewrite(self, element: Element) -> None:
        """Rewrite the numbers of an element and all below it."""
        for each in element.below():
            if each.tag == "pose" and each.text and (self.degrees or self.snap):
                self._turn(each)
            elif self.digits and _is_real(each.text):
                each.text = " ".join(self._number(float(word)) for word in each.text.split())

    def _turn(self, element: Element) -> None:
        pose = element.pose()
        angles = [self._snapped(math.degrees(angle)) for angle in pose.rpy()]
        element.attributes.pop("rotation_format", None)
        element.attributes["degrees"] = "true"
        element.text = " ".join(self._number(float(value)) for value in (*pose.position, *angles))

    def _snapped(self, angle: float) -> float:
        nearest = self.snap * round(angle / self.snap) if self.snap else math.inf
        return float(nearest) if abs(angle - nearest) < self.tolerance else angle

    def _number(self, value: float) -> str:
        return f"{value + 0.0:.{self.digits or _EXACT}g}" if self.digits else repr(value + 0.0).removesuffix(".0")


def _is_real(text: str) -> bool:
    words = text.split()
    return any("." in word for word in words) and all(_REAL.fullmatch(word) for word in words)


def state_inertia(model: Model) -> None:
    """Replace `<inertial auto="true">` in the links of a model by the values that were computed for them."""
    for link in model.links:
        element = link.element.find("inertial")
        if element is None or not is_automatic(element):
            continue
        ixx, iyy, izz, ixy, ixz, iyz = link.inertial.moments
        moments = {"ixx": ixx, "ixy": ixy, "ixz": ixz, "iyy": iyy, "iyz": iyz, "izz": izz}
        pose = (*link.inertial.pose.position, *link.inertial.pose.rpy())
        element.attributes.pop("auto")
        element.children = [
            Element("pose", text=" ".join(repr(float(value) + 0.0) for value in pose)),
            Element("mass", text=repr(link.inertial.mass)),
            Element("inertia", children=[Element(tag, text=repr(float(value))) for tag, value in moments.items()]),
        ]


def inertia_lines(model: Model) -> Iterator[str]:
    """Yield mass, centre of mass and inertia of the links of a model, without those of nested models."""
    if model.nested:
        yield "Warning: Inertial properties of links in nested models will not be included."
    links = [link for link in model.links if "::" not in link.name]
    mass = sum(link.inertial.mass for link in links)
    places = [(link.pose * link.inertial.pose, link.inertial) for link in links]
    centre = sum((inertial.mass * pose.position for pose, inertial in places), np.zeros(3)) / (mass or 1.0)
    total = np.zeros((3, 3))
    for pose, inertial in places:
        turn = matrix(pose.quaternion)
        total += turn @ tensor(inertial.moments) @ turn.T + inertial.mass * point_inertia(pose.position - centre)
    yield from (f"Inertial statistics for model: {model.name}", "---", f"Total mass of the model: {mass:g}", "---")
    yield "Centre of mass in model frame: "
    yield from (f"{axis}: {value + 0.0:g}" for axis, value in zip("XYZ", centre, strict=True))
    yield from ("---", "Moment of inertia matrix: ")
    words = [f"{value + 0.0:g}" for value in total.flat]
    width = max(map(len, words))
    for row in range(3):
        yield "".join(f"{word:<{width}}  " for word in words[3 * row : 3 * row + 3])
    yield "---"
