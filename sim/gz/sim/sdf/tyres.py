"""Friction of a driven wheel that differs across and along its tyre: `mu2` and `slip1`, with `fdir1` along the axle.

Source: http://sdformat.org/spec?elem=collision (surface/friction/ode)
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gz_course.sim.gz.sim.pose import Vector, rotate
from gz_course.sim.gz.sim.sdf.description import Collision, Model

ROUND = ("cylinder", "sphere")
"""The shapes that can be a tyre."""
_PARALLEL = 0.99  # cosine of the angle between two directions that are taken for the same


@dataclass(frozen=True)
class Tyre:
    """Friction coefficients across (along the axle) and along the tyre, and the slip across [m/(N s)]: the speed with
    which it gives way to a force.
    """

    across: float
    along: float
    slip: float = 0.0


def read_tyre(part: Collision, axle: Vector) -> Tyre | None:
    """Return what a collision states of directions; None if it is the same in all, or they are not those of a wheel.

    `axle` is the axis of the wheel's joint in the frame of the link.
    """
    ode = part.element.find("surface/friction/ode")
    if ode is None or part.geometry.kind not in ROUND:
        return None
    along, slip = max(0.0, ode.number("mu2", part.mu)), ode.number("slip1", 0.0)
    first = np.array(ode.vector("fdir1", (0.0, 0.0, 0.0)))
    length = float(np.linalg.norm(first) * np.linalg.norm(axle))
    if (along == part.mu and not slip > 0.0) or not 0.0 < length < math.inf or not slip < math.inf:
        return None
    if abs(float(rotate(part.pose.quaternion, first) @ axle)) < _PARALLEL * length:
        return None
    return Tyre(part.mu, min(along, 1e6), max(0.0, slip))


def wheels(model: Model) -> Iterator[tuple[Collision, Vector]]:
    """Yield each collision of the wheels that DiffDrives of a model name, with the axis of its joint."""
    for plugin in model.plugins:
        if not plugin.name.endswith("DiffDrive"):
            continue
        prefix = f"{plugin.scope}::" if plugin.scope else ""
        for element in (*plugin.element.all("left_joint"), *plugin.element.all("right_joint")):
            joint = model.joint(prefix + element.text)
            link = model.link(joint.child) if joint is not None else None
            if joint is not None and link is not None and joint.axis is not None:
                for part in link.collisions:
                    yield part, np.array(joint.axis.direction)


def is_stated(model: Model) -> set[int]:
    """Return the ids of the collisions of a model whose directions of friction are simulated."""
    return {id(part) for part, axle in wheels(model) if read_tyre(part, axle) is not None}
