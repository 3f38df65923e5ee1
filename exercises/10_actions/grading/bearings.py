"""What a server takes for its heading, or for the direction to a waypoint, as the way tells that the robot drives."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .patrol_run import Run

DRIVES = 0.08  # [m/s]
FACES = 0.35  # [rad] a server that drives believes that the waypoint is ahead
FEWEST = 20  # samples of a robot that drives
TURNS = 0.02  # [rad/s] a robot that turns less steers by no angle
REACHED = 0.17  # [m]
BESIDE = 0.8  # [m] from a waypoint
STRAIGHT = 0.05  # [rad/s]
ENOUGH = 2.0  # [m] of the way, before the robot comes to a wall
HALF_A_SECOND = 10  # samples
ASIDE = 0.8  # [rad]
RIGHT = "the heading is 2 * atan2(orientation.z, orientation.w), in radians"
HEADINGS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    f"its heading is in degrees, and atan2 returns radians: {RIGHT}": np.degrees,
    f"its heading is half of what it is: {RIGHT}": lambda yaw: yaw / 2,
    f"its heading has the wrong sign: {RIGHT}": lambda yaw: -yaw,
    f"its heading is never negative, as of acos: {RIGHT}": np.abs,
    f"its heading does not change when the robot turns: {RIGHT}": lambda yaw: 0 * yaw,
}
DIRECTIONS = {
    "it takes the direction to a waypoint for atan2(dx, dy); atan2 takes y first": lambda d, p: np.arctan2(
        d[:, 0], d[:, 1]
    ),
    "it takes the opposite direction, from the waypoint to the robot: dx is waypoint.x - x, and dy is waypoint.y - y": (
        lambda d, p: np.arctan2(-d[:, 1], -d[:, 0])
    ),
    "it takes the direction from the origin of odom to the waypoint; dx and dy begin where the robot is": (
        lambda d, p: np.full(len(d), np.arctan2(p[1], p[0]))
    ),
}


def _wrapped(angle: np.ndarray) -> np.ndarray:
    return np.remainder(angle + np.pi, 2 * np.pi) - np.pi


def _missed(way: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, int]:
    """Return the first waypoint that a way misses, and where in the way the robot sets out for it."""
    after = 0
    for point in points:
        left = np.hypot(*(way[after:] - point).T)
        if left.min() > REACHED:
            return point, after
        after += int(np.argmax(left <= REACHED))
    return points[-1], len(way) - 1


def wrong_bearing(run: Run, chosen: np.ndarray, points: np.ndarray) -> str:
    """Return by which wrong angle the server faces a waypoint that the robot misses; empty if none fits its way."""
    way, yaw, speed, rate = (each[chosen] for each in (run.way, run.heading, run.linear.values, run.angular.values))
    missed, after = _missed(way, points)
    there = missed - way[after:]
    if words := _one_sided(run, _wrapped(np.arctan2(there[:, 1], there[:, 0]) - yaw[after:])):
        return words
    if words := _turned_past(np.arctan2(there[:, 1], there[:, 0]), yaw[after:], speed[after:], rate[after:]):
        return words
    driven = np.cumsum(np.hypot(*np.diff(way[after:], axis=0, prepend=way[after : after + 1]).T))
    part = slice(after, min(_blocked(way), after + int(np.sum(driven < ENOUGH))))
    way, yaw, speed, rate = way[part], yaw[part], speed[part], rate[part]
    driving, beside = speed > DRIVES, missed - way
    if driving.sum() < FEWEST or np.abs(rate).max() < TURNS:
        return ""
    direction = np.arctan2(beside[:, 1], beside[:, 0])
    error = _wrapped(direction - yaw)
    if np.mean(np.abs(error[driving]) < FACES) > 0.5:
        return ""
    errors = {words: _wrapped(direction - taken(yaw)) for words, taken in HEADINGS.items()}
    errors |= {words: _wrapped(taken(beside, missed) - yaw) for words, taken in DIRECTIONS.items()}
    fits = {words: _fit(each, driving, rate) for words, each in errors.items()}
    first, second = sorted(fits, key=fits.__getitem__)[:-3:-1]
    off = np.degrees(np.median(np.abs(error[driving])))
    if fits[first] > 0.85:
        sure = fits[first] - fits[second] > 0.1
        why = first if sure else "its heading, or the direction to the waypoint, atan2(dy, dx), is wrong"
        return f"Your server drives as if the waypoint were ahead, and it is {off:.0f} degrees beside: {why}"
    aside = driving & (np.abs(error) > ASIDE)
    if aside.sum() > 0.5 * driving.sum() and np.mean(np.sign(rate[aside]) == np.sign(error[aside])) > 0.8:
        return (
            f"The robot turns to the correct side, but drives on although the waypoint is {off:.0f} degrees beside its "
            "heading, so it circles: let it drive only while the angle to turn by is small"
        )
    return ""


def backwards(run: Run) -> str:
    """Find out whether a server sends negative speeds nearly always."""
    sent = run.recording.signal("topics/cmd_vel/linear/x").values
    sent = sent[np.abs(sent) > DRIVES / 4]
    if len(sent) < FEWEST or np.mean(sent < 0) < 0.8:
        return ""
    return (
        f"Your server drives backwards: linear.x of its commands is negative, {sent.min():.2f} m/s, and a positive one "
        "drives ahead"
    )


def driven_past(run: Run, chosen: np.ndarray, points: np.ndarray) -> str:
    """Find out whether a robot drives past a waypoint on a straight line, without turning while it drives."""
    way, speed, rate = (each[chosen] for each in (run.way, run.linear.values, run.angular.values))
    missed, after = _missed(way, points)
    left = np.hypot(*(way[after:] - missed).T)
    nearest = int(np.argmin(left))
    driving = speed[after : after + nearest + 1] > DRIVES
    if driving.sum() < FEWEST or np.quantile(np.abs(rate[after : after + nearest + 1][driving]), 0.8) > STRAIGHT:
        return ""
    if left[nearest] > BESIDE or left[nearest:].max() < left[nearest] + 0.3:
        return ""
    return (
        f"The robot drives straight past the waypoint, {left[nearest]:.2f} m beside it: angular.z is 0 while it "
        "drives, so the error that is left when it sets off is never corrected"
    )


def _one_sided(run: Run, error: np.ndarray) -> str:
    """Find out whether all turns of a run are to one side, where the waypoint is on the other."""
    sent = run.recording.signal("topics/cmd_vel/angular/z").values
    if len(sent) < FEWEST or np.abs(sent).max() < TURNS:
        return ""
    for sign, never, side in ((1, "negative", "right"), (-1, "positive", "left")):
        if (sign * sent >= 0).all() and np.mean((sign * error < -FACES) & (sign * error > FACES - np.pi)) > 0.5:
            return (
                f"The robot never turns to the {side}, where its waypoint is: angular.z is never {never}, as with a "
                "limit of 0 on one side, or abs()"
            )
    return ""


def _turned_past(direction: np.ndarray, yaw: np.ndarray, speed: np.ndarray, rate: np.ndarray) -> str:
    """Find out whether a robot turns on over the direction of the waypoint and does not drive there."""
    error = _wrapped(direction - yaw)
    ahead = np.flatnonzero(np.abs(error) < 0.1)
    if not len(ahead) or (speed[ahead[0] :] > DRIVES).any() or (np.abs(error[: ahead[0]]) < ASIDE / 2).all():
        return ""
    if np.abs(error[ahead[0] :]).max() < ASIDE / 2:
        return ""
    turning = np.abs(rate) > 0.1
    fits = {
        words: float(np.mean(np.sign(rate[turning]) == np.sign(_wrapped(direction - taken(yaw))[turning])))
        for words, taken in HEADINGS.items()
    }
    first, second = sorted(fits, key=fits.__getitem__)[:-3:-1]
    sure = turning.sum() >= FEWEST and fits[first] > 0.95 and fits[second] < 0.85
    why = first if sure else "its heading, or the direction to the waypoint, atan2(dy, dx), is wrong"
    return f"The robot turned past the waypoint, which was ahead of it, and did not drive: {why}"


def _blocked(way: np.ndarray) -> int:
    """Return from where on the robot does not get away from its place any more, as at a wall."""
    if len(way) <= HALF_A_SECOND:
        return len(way)
    gone = np.hypot(*(way[HALF_A_SECOND:] - way[:-HALF_A_SECOND]).T)
    moving = np.flatnonzero(gone > DRIVES / 2)
    return int(moving[-1]) + HALF_A_SECOND if len(moving) else len(way)


def _fit(error: np.ndarray, driving: np.ndarray, rate: np.ndarray) -> float:
    """Return how often a robot that drives has an error of nearly 0, and one that turns makes its error smaller."""
    fits = [float(np.mean(np.abs(error[driving]) < FACES))]
    turning = (np.abs(error) > FACES) & (np.abs(error) < np.pi - FACES) & (np.abs(rate) > 0.1)
    if turning.sum() >= FEWEST // 2:
        fits.append(float(np.mean(np.sign(rate[turning]) == np.sign(error[turning]))) + 0.1)
    on_the_spot = ~driving & (np.abs(rate) > 0.3)
    if on_the_spot.sum() >= FEWEST // 2:  # who believes to face the waypoint does not turn on the spot
        fits.append(float(np.mean(np.abs(error[on_the_spot]) > 0.15)) + 0.1)
    return min(fits)
