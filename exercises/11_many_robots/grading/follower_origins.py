"""Where a follower takes the robot in front to be, if not 1.2 m ahead of where its odometry begins."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.grader.record.reading import Recording

if TYPE_CHECKING:
    from .follower_fits import Heard

GAP = 1.2  # [m]
FITS = 0.995  # of the variance of the commands that a line must explain
BETTER = 0.5  # of what is unexplained otherwise: so much another place must explain
PLACES = np.arange(-3.6, 6.01, 0.1)  # [m] ahead of the follower's own beginning
LEAST = 0.15  # [m/s] from which on a robot starts at once, and not little by little
NEAR = 0.25  # [m] to the right place, or to none: other words name that


def begun_elsewhere(every: list[Heard], line: Callable[..., Any]) -> str:
    """Return where a follower takes the robot in front to have begun, if that fits its speeds much better than 1.2 m.

    On a straight way, a place and a gap that is kept cannot be told apart: only what goes to the side tells.
    """
    v = every[0].linear
    found = []
    for h in every:
        for place in PLACES:
            to_robot = np.hypot(h.front_x + place - h.x, h.aside)
            for length in (to_robot, _ahead_of(h, place) + GAP):
                fit = line(length, v)
                if fit is not None and fit[0] > 0:
                    found.append((fit[2], float(place), -fit[1] / fit[0]))
    if not found:
        return ""
    best, place, gap = max(found)
    usual = max((fit for fit, other, _ in found if min(abs(other - GAP), abs(other)) < NEAR), default=0.0)
    if best < FITS or best < usual + BETTER * (1 - usual) or min(abs(place - GAP), abs(place)) < NEAR:
        return ""
    if not 0.9 < gap < 1.5:
        return ""
    where = f"{place:.1f} m ahead of" if place > 0 else f"{-place:.1f} m behind"
    return (
        f"it takes the robot in front to have begun {where} its own robot, but it began {GAP} m ahead: "
        "front.x + 1.2 - own.x is how far ahead it is, for every pair"
    )


def _ahead_of(h: Heard, begins: float = GAP) -> np.ndarray:
    """Return how far ahead the place 1.2 m behind the robot in front is, along the follower's own direction."""
    x = h.front_x + begins - GAP * np.cos(h.front_heading) - h.x
    y = h.front_y - GAP * np.sin(h.front_heading) - h.y
    return np.cos(h.heading) * x + np.sin(h.heading) * y


def to_the_place(every: list[Heard], line: Callable[..., Any], usual: float = 0.0) -> str:
    """Return what is wrong with a speed that is made of the distance to the place behind the robot in front.

    `usual` is how well the distance to that robot explains the speeds.
    """
    best, zero, past = 0.0, 0.0, False
    for h in every:
        x = h.front_x + GAP - GAP * np.cos(h.front_heading) - h.x
        y = h.front_y - GAP * np.sin(h.front_heading) - h.y
        nearer = bool((h.distance < GAP - 0.1).sum() >= 3)
        for length, unsigned in ((np.hypot(x, y), True), (_ahead_of(h), False)):
            fit = line(length, every[0].linear)
            if fit is not None and fit[0] > 0 and fit[2] > best:
                best, zero, past = fit[2], -fit[1] / fit[0], unsigned and nearer
    if best < max(FITS, usual + BETTER * (1 - usual)):
        return ""
    if abs(zero) < NEAR and past:
        return (
            "its speed is made of the distance to the place behind the robot in front, which has no sign: beyond that "
            "place it drives on instead of standing there"
        )
    if abs(zero - GAP) < NEAR:
        return "it keeps 1.2 m to the place that is 1.2 m behind the robot in front: the gap is subtracted twice"
    return ""


def other_places(every: list[Heard], line: Callable[..., Any], usual: float = 0.0) -> str:
    """Return to which other place than that behind the robot in front a follower drives; empty if to none known.

    `usual` is how well the distance to that robot explains the speeds.
    """
    right, found = 0.0, []
    for h in every:
        for words, (east, north) in _places(h):
            x, y = h.front_x + GAP + east - h.x, h.front_y + north - h.y
            for length in (np.hypot(x, y), np.cos(h.heading) * x + np.sin(h.heading) * y):
                fit = line(length, h.linear)
                if fit is None or fit[0] <= 0 or abs(fit[1] / fit[0]) > NEAR:
                    continue
                right = max(right, fit[2]) if not words else right
                found.append((fit[2], words))
    best, words = max(found, default=(0.0, ""))
    least = max(right, usual)
    return words if best > max(FITS, least + BETTER * (1 - least)) else ""


def to_behind(every: list[Heard], line: Callable[..., Any]) -> bool:
    """Return whether the speeds are made of how far ahead the place behind the robot in front is, as they may be."""
    for h in every:
        fit = line(_ahead_of(h), every[0].linear)
        if fit is not None and fit[0] > 0 and fit[2] > FITS and abs(fit[1] / fit[0]) < NEAR:
            return True
    return False


def _places(h: Heard) -> Iterator[tuple[str, tuple[np.ndarray, np.ndarray]]]:
    """Yield places beside the robot in front, from its middle; without words that behind it."""
    c, s = GAP * np.cos(h.front_heading), GAP * np.sin(h.front_heading)
    yield "", (-c, -s)
    yield (
        "it drives to the place 1.2 m ahead of the robot in front, and not behind it: behind is "
        "x - 1.2 * cos(heading), y - 1.2 * sin(heading)",
        (c, s),
    )
    yield (
        "it exchanges cos and sin in the place behind the robot in front: that is x - 1.2 * cos(heading), "
        "y - 1.2 * sin(heading)",
        (-s, -c),
    )


def behind(every: list[Heard]) -> str:
    """Return what a follower that falls behind does meanwhile: it is slow, or it does not face the other robot."""
    h = every[0]
    far = h.distance > GAP + 0.45
    if far.sum() < 8:
        return ""
    angle = np.arctan2(h.aside, h.ahead) - h.heading
    beside = float(np.median(np.abs(np.arctan2(np.sin(angle), np.cos(angle)))[far]))
    fast = float(np.median(h.linear[far]))
    if beside > 0.5:
        return f"it does not turn to the robot in front, which is {beside:.1f} rad beside its own direction meanwhile"
    return f"its speed is about {fast:.2f} m/s meanwhile" if fast < 0.45 else ""


def sideways(recording: Recording, name: str) -> str:
    """Return that a follower sends its speed in a field that a robot on two wheels does not obey; else nothing."""
    base = f"topics/{name}/cmd_vel"
    for field in ("linear/y", "linear/z", "angular/x", "angular/y"):
        values = recording.signal(f"{base}/{field}").values
        right = "linear/x" if field.startswith("linear") else "angular/z"
        if len(values) and np.abs(values).max() > 0.02 and not recording.signal(f"{base}/{right}").values.any():
            wrong, right = field.replace("/", "."), right.replace("/", ".")
            what = "drives along" if right == "linear.x" else "turns about"
            return f"it sends {wrong} and no {right}: a robot on two wheels {what} {right[-1]} only, so that is {right}"
    return ""


def drives_from(every: list[Heard]) -> str:
    """Return from which distance on a follower drives, if it stands still although it is farther than the gap.

    If its speeds are zero where it does not face the robot in front instead, return from which angle on.
    """
    for h in every:
        zero = np.abs(h.linear) < 1e-6
        angle = np.abs(np.arctan2(np.sin(t := np.arctan2(h.aside, h.ahead) - h.heading), np.cos(t)))
        far = h.distance > GAP + 0.1
        if (far & zero).sum() < 3 or (far & ~zero).sum() < 3:
            continue
        jumps = np.quantile(h.linear[far & ~zero], 0.1) > LEAST
        if jumps and _parted(h.distance[zero & far], h.distance[~zero & far]):
            from_on = float(h.distance[~zero & far].min())
            return f"it drives only from a distance of about {from_on:.1f} m on, and stands still where it is less"
        if _parted(angle[~zero & far], angle[zero & far]):
            most = float(angle[~zero & far].max())
            return (
                f"it stands still where the robot in front is more than about {most:.2f} rad to the side, and falls "
                "behind meanwhile: drive and turn at once, or let the angle be larger"
            )
    return ""


def _parted(low: np.ndarray, high: np.ndarray) -> bool:
    """Return whether nearly all of some numbers are below nearly all of others."""
    return np.quantile(low, 0.9) < np.quantile(high, 0.1)
