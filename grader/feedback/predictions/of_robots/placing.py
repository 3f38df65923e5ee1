"""Why a robot that a launch created is at another place than its arguments name."""

from __future__ import annotations

import math
from collections.abc import Mapping

from gz_course.grader.feedback.rules import guarded
from gz_course.grader.score.steps import told

NEAR = 0.02  # [m] and [rad] between equal values: a robot settles a little where it comes
EXACT = 0.001  # [rad]: a heading in degrees that is taken for radians is small
ALIKE = 0.05  # wanted values that are closer to each other cannot be told apart


@guarded("")
def misplaced(
    wanted: Mapping[str, float], place: Mapping[str, float], wrong: list[str], names: Mapping[str, str]
) -> str:
    """Return which misconception puts a robot at `place`; empty if none does.

    The keys are x, y and yaw ([m], [rad]), `wrong` are those at fault, `names` those of the launch arguments.
    """
    if {"x", "y"} <= set(wrong) and all(abs(place[a] - wanted[b]) < NEAR for a, b in (("x", "y"), ("y", "x"))):
        return f"the arguments {names['x']} and {names['y']} are exchanged"
    found = [_one(axis, wanted, place[axis], names) for axis in wrong]
    return "; ".join(found) if all(found) else ""


def _one(axis: str, wanted: Mapping[str, float], value: float, names: Mapping[str, str]) -> str:
    right = wanted[axis]
    if abs(right) < ALIKE:
        other = next((each for each in wanted if each != axis and _same(axis, value, wanted[each])), "")
        return f"the value of {names[other]} was taken for {names[axis]}" if other else ""
    if axis == "yaw" and abs(value - math.radians(right)) < EXACT < abs(value):
        return f"{names[axis]} was converted from degrees to radians, but it is in radians ({told(right)})"
    if abs(value) < NEAR:
        return f"the argument {names[axis]} had no effect"
    if _same(axis, value, -right):
        return f"{names[axis]} has the wrong sign"
    if axis == "yaw" and _same(axis, value, math.degrees(right)):
        return f"{names[axis]} was converted from radians to degrees, but -Y of create is in radians"
    for each in wanted:
        if each != axis and abs(wanted[each]) > ALIKE and _same(axis, value, wanted[each]):
            return f"the value of {names[each]} was taken for {names[axis]}"
    return ""


def _same(axis: str, one: float, other: float) -> bool:
    off = one - other
    return abs(math.remainder(off, math.tau) if axis == "yaw" else off) < NEAR
