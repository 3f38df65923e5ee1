"""By which wrong angle a follower steers, as its commands tell."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .follower_fits import ASTRAY, FITS, PLACES, Heard, best, closest, copied, sides, wrapped
from .follower_origins import GAP

AWAY = 0.95  # of the commands that turn to the other side than that of the robot in front
TURNED = 1.0  # [rad]


def turning(every: list[Heard]) -> str:
    """Return which wrong angle the follower steers by; empty if none fits clearly better than the right one."""
    if any(copied(h.angular, h.front_angular) for h in every):
        return "it sends the turning rate of the robot in front"
    right = closest([(wrapped(np.arctan2(h.aside, h.ahead) - h.heading), "") for h in every], every[0].angular)
    if right is not None and right[0] > 0 and abs(right[1]) > TURNED * right[0]:
        right = None  # it is at rest where the robot in front is aside
    if right is not None and right[2] > FITS:
        return "it turns away from the robot in front: the sign of angular.z is wrong" if right[0] < 0 else ""
    said = best([each for h in every for each in _angles(h)], every[0].angular, right, ASTRAY)
    away = max(sides(h.heading - np.arctan2(h.aside, h.ahead), h.angular) for h in every)
    if said or away < AWAY:
        return said
    return (
        "it turns away from the robot in front: the sign of angular.z is wrong, or the direction is that from it to "
        "the follower; it is atan2(front.y - own.y, front.x - own.x)"
    )


def _angles(h: Heard) -> Iterator[tuple[np.ndarray, str]]:
    bearing = np.arctan2(h.aside, h.ahead)
    begins = np.arctan2(h.front_y - h.y, h.front_x - h.x)
    half = h.heading / 2
    yield (
        wrapped(bearing),
        "it turns by the direction to the robot in front, and does not subtract its own heading, or one that is always "
        "0, as from orientation.x or .y",
    )
    yield (
        np.pi / 2 - wrapped(bearing - h.heading),
        "it exchanges the arguments of atan2: the angle to a place is atan2(y, x)",
    )
    yield (
        wrapped(bearing + np.pi - h.heading),
        "it turns its back to the robot in front: the direction is turned by pi, as by atan2(own.y - front.y, own.x - "
        "front.x), or by an angle that lacks the last - pi",
    )
    yield wrapped(np.arctan2(h.front_y + GAP - h.y, h.front_x - h.x) - h.heading), "it adds the 1.2 m to y, not to x"
    yield (
        wrapped(bearing - np.sin(half)),
        "it takes orientation.z, the sine of half its heading, for its heading: that is 2 * atan2(z, w)",
    )
    yield wrapped(bearing - half), "its own heading is half of what it is: the heading is 2 * atan2(z, w)"
    yield wrapped(bearing + h.heading), "it adds its own heading to the direction instead of subtracting it"
    yield (
        wrapped(np.arctan2(h.ahead, h.aside) - h.heading),
        "it exchanges the arguments of atan2: the angle to a place is atan2(y, x)",
    )
    yield (
        wrapped(bearing - h.front_heading),
        "it subtracts the heading of the robot in front from the direction, and not its own heading",
    )
    yield (
        wrapped(np.arctan2(np.abs(h.aside), h.ahead) - h.heading),
        "it turns to the left only: the sign of the difference of the two y is lost, as by abs()",
    )
    yield np.degrees(bearing) - h.heading, "the direction is in degrees, its own heading in radians"
    yield bearing - np.degrees(h.heading), "its own heading is in degrees, the direction in radians"
    yield wrapped(begins - h.heading), f"the direction in which it turns is wrong: {PLACES}"
    yield (
        wrapped(h.front_heading - h.heading),
        "it turns by the heading of the robot in front, not towards the place of that robot",
    )
