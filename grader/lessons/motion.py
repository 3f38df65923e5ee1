"""How a model moves, from its true poses."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

from gz_course.grader.lessons.step import Pose


@dataclass(frozen=True)
class Motion:
    """Mean speed ahead [m/s] and turning rate [rad/s], way along the track [m], angle turned [rad], time passed [s]."""

    speed: float
    rate: float
    way: float
    turned: float
    passed: float

    def __str__(self) -> str:
        return f"drives at {self.speed:z.2f} m/s and turns at {self.rate:z.2f} rad/s"


def motion_of(poses: Sequence[Pose]) -> Motion:
    """Return how the model moved through two or more poses. Left is positive."""
    pairs = list(itertools.pairwise(poses))
    turned = sum(math.remainder(b.yaw - a.yaw, math.tau) for a, b in pairs)
    ahead = sum((b.x - a.x) * math.cos(a.yaw) + (b.y - a.y) * math.sin(a.yaw) for a, b in pairs)
    way = sum(math.hypot(b.x - a.x, b.y - a.y) for a, b in pairs)
    passed = poses[-1].time - poses[0].time
    return Motion(ahead / passed, turned / passed, way, turned, passed)
