"""How a model moves, from its true poses."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

from gz_course.grader.lessons.step import Pose, Tried, expect

SECONDS = 2.0  # of simulated time in which a motion is looked at
SETTLED = 10  # poses from the moment that a model is placed, or commanded, until it moves evenly


@dataclass(frozen=True)
class Motion:
    """Mean speed ahead [m/s] and turning rate [rad/s], way along the track [m], angle turned [rad], time passed [s]."""

    speed: float
    rate: float
    way: float
    turned: float
    passed: float

    @property
    def stands(self) -> bool:
        """Whether the model stands still."""
        return abs(self.speed) < 0.02 and abs(self.rate) < 0.02

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


def motion_in_the_middle(tried: Tried, seconds: float = SECONDS) -> Motion:
    """Return how the robot moves for so long [s] in the middle of the room, away from the walls."""
    tried.place("robot", 0.0, 0.0)
    return motion_of(tried.poses("robot", seconds)[SETTLED:])


def expect_turn(moves: Motion, rate: float) -> None:
    """Raise NotYet unless the robot turns on the spot at this rate [rad/s]; left is positive."""
    seen = f"The robot {moves}"
    there, sign = ("left", "positive") if rate > 0 else ("right", "negative")
    other = "right" if rate > 0 else "left"
    expect(abs(moves.speed) < 0.03, f"{seen}; on the spot means 0 m/s.")
    wrong_way = moves.rate * rate < 0 and abs(moves.rate) >= 0.05
    expect(not wrong_way, f"{seen}, to the {other}; a turn to the {there} is {sign}.")
    expect(abs(moves.rate - rate) < 0.05, f"{seen}; {rate:g} rad/s is wanted.")
