"""What a system with one more fault measures and commands: each function names the misconception that fits, or nothing.

Distances are in metres, speeds in metres per second.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

CLOSE = 0.03  # [m] of distances that are taken for equal; the noise of the lidar is 0.005 m
SHARE = 0.9  # of the values that a misconception must fit
FEWEST = 5  # values; fewer may fit by chance
GAIN = 1.5  # [1/s] of the driver as it was given
FASTEST = 0.6  # [m/s] of the driver as it was given
STANDS = 0.01  # [m/s]
OLDEST = 0.5  # [s] of a distance that the driver as it was given uses
HEIGHT = 0.06  # [m] of base_link above the ground
FRONT = 0.2  # [m] from base_link
DEFAULT = 1.0  # [m] stop_at if it is not given


def of_a_mount(seen: Sequence[float], mount: tuple[float, float, float], sign: int) -> str:
    """Explain a wrong place of the lidar in base_link; `sign` is -1 if base_link is the child of the transform."""
    if math.dist([-each for each in seen], mount) < 0.005:
        if sign < 0:
            return "the transform is inverted: parent and child are swapped"
        return (
            "the transform is inverted: its numbers are the place of base_link, seen from lidar_link; with base_link "
            f"as the parent, they are that of lidar_link: x = {mount[0]:g}, z = {mount[2]:g}"
        )
    if sign < 0:
        return (
            "parent and child are swapped: lidar_link is the parent here, and its numbers do not fit that either; with "
            f"base_link as the parent, they are x = {mount[0]:g}, z = {mount[2]:g}"
        )
    for factor, unit in ((1000, "millimetres"), (100, "centimetres")):
        if math.dist([each / factor for each in seen], mount) < 0.005:
            return f"the transform is given in {unit}; tf2 takes metres"
    wrong = [name for name, one, other in zip("xyz", seen, mount, strict=True) if abs(one + other) < 0.005 < abs(one)]
    others = [name for name, one, other in zip("xyz", seen, mount, strict=True) if abs(one - other) >= 0.005]
    if wrong and wrong == others:
        return f"the sign of {' and '.join(wrong)} is wrong"
    if others == ["z"] and abs(seen[2] - mount[2] - HEIGHT) < 0.005:
        return "z is the height above the ground; base_link itself is above the ground"
    if len(others) > 1 and sorted(round(each, 2) for each in seen) == sorted(round(each, 2) for each in mount):
        return "the numbers stand at the wrong axes: x points ahead, y to the left, z up"
    if not any(round(each, 3) for each in seen):
        return "the transform says that both frames are at the same place"
    return ""


def of_a_turned_mount(turn: list[float]) -> str:
    """Say about which axis a transform turns the lidar, given x, y and z of the quaternion."""
    largest = max(range(3), key=lambda each: abs(turn[each]))
    angle = 2 * math.asin(max(-1.0, min(1.0, turn[largest])))
    axis = ("x (--roll)", "y (--pitch)", "z (--yaw)")[largest]
    return f"the transform turns the lidar, which looks ahead, by {angle:.2f} rad about {axis}"


def of_a_distance(measured: np.ndarray, truth: np.ndarray, mount: float) -> str:
    """Explain distances to the wall that are wrong, given the true ones and the lidar's x in base_link."""
    for words, wrong in (
        ("the distance is measured from the lidar, and is asked for from base_link", truth - mount),
        ("the place of the lidar on the cart is taken with the wrong sign", truth - 2 * mount),
        ("the distance is measured from the front of the cart, and is asked for from base_link", truth - FRONT),
        ("the distance is given in centimetres", truth * 100),
        ("the distance is given in millimetres", truth * 1000),
        ("the distance has the wrong sign", -truth),
    ):
        if _fits(measured, wrong) and not _fits(measured, truth):
            return words
    if _fits(measured, truth) or len(measured) < FEWEST:
        return ""
    if np.ptp(measured) < CLOSE < np.ptp(truth):
        return f"every distance is {measured[-1]:.2f} m, however far the wall is"
    error = measured - truth
    usual = float(np.median(error))
    same = np.mean(np.abs(error - usual) < CLOSE / 2) >= SHARE
    worst = int(np.argmax(np.abs(error)))
    if np.ptp(truth) > 1.0 and np.all(measured == np.round(measured)):
        kind = "" if np.median(np.abs(error)) < 1.0 else ": that is a count, or a place in a list, and no distance"
        seen = f"{measured[worst]:.0f} m where it is {truth[worst]:.2f} m"
        return f"every distance is a whole number of metres, {seen}{kind}"
    if same and np.ptp(truth) > 4 * CLOSE and abs(usual) > 2 * CLOSE:
        return f"every distance is {abs(usual):.2f} m too {'small' if usual < 0 else 'large'}, near the wall and far"
    if np.mean(error < -CLOSE) >= SHARE:
        return (
            f"the distance is too small, {measured[worst]:.2f} m where the wall is {truth[worst]:.2f} m away; nothing "
            "stands ahead that is nearer than the wall"
        )
    if np.mean(error > CLOSE) >= SHARE:
        return f"the distance is too large, {measured[worst]:.2f} m where the wall is {truth[worst]:.2f} m away"
    return ""


def of_a_driver(distance: np.ndarray, speed: np.ndarray, wanted: float) -> str:
    """Explain speeds that are wrong, given the latest distance at each and the distance that was asked for."""
    left = distance - wanted
    if len(speed) < FEWEST:
        return ""
    if _drives(speed, left):
        return ""
    if not np.any(np.abs(speed) > STANDS):
        return "every command is zero although distances arrive"
    away = (np.abs(left) > CLOSE) & (np.abs(speed) > STANDS)
    if away.sum() >= FEWEST and np.mean(speed[away] * left[away] < 0) >= SHARE:
        return "the sign of linear.x is wrong: it drives away from the wall"
    if np.ptp(speed) < STANDS and np.ptp(distance) > 4 * CLOSE:
        if speed[-1] > 0 and left.min() > FRONT:
            return f"every command is {speed[-1]:.2f} m/s, which is too slow: {left[-1]:.2f} m are left at the end"
        return f"every command is {speed[-1]:.2f} m/s, however far the wall is: it does not fall as the wall comes near"
    if _adds_up(speed, left):
        return "each command is the last one and a share of what is left: a speed that adds up comes to 0 too late"
    if abs(wanted + FRONT - DEFAULT) > CLOSE and _drives(speed, left - FRONT):
        return "the distance is taken from the front of the cart, and it is asked for from base_link"
    if (other := _aim(distance, speed)) is not None and abs(other - wanted) > CLOSE:
        why = (
            ": that is its default, and the value that was given is not used"
            if abs(other - DEFAULT) < CLOSE / 2
            else ""
        )
        if abs(other) < CLOSE / 2:
            why = ": it is not taken off the distance"
        if abs(other - int(wanted)) < CLOSE / 2 and wanted > int(wanted):
            why = ", which has lost its fraction, as by int()"
            why += "" if int(wanted) else ", or is not taken off the distance"
        aim = f"the commands drive the cart to {other:.2f} m from the wall"
        return f"{aim}, not to the {wanted:g} m that stop_at says{why}"
    past = left < -CLOSE
    if past.sum() >= FEWEST and np.min(speed[past]) > STANDS:
        return (
            f"it drives on, with {np.min(speed[past]):.2f} m/s or more, where the wall is nearer than the {wanted:g} m "
            "that stop_at says: the speed must fall to 0 there"
        )
    before = speed[: np.flatnonzero(np.abs(speed) > STANDS)[-1]]  # it comes to rest
    still = np.mean(np.abs(before) <= STANDS) if len(before) >= FEWEST else 0.0
    far = np.abs(left[: len(before)]) > 2 * CLOSE
    if still > 0.2 and far.any() and np.mean(np.abs(before[far]) <= STANDS) > 0.2:
        return (
            f"{100 * still:.0f} % of the commands before it comes to rest are zero: distances are dropped, or each "
            "is used only once"
        )
    driven = speed[np.abs(speed) > STANDS]
    if np.ptp(np.abs(driven)) < STANDS < np.ptp(driven):
        return (
            f"every command is {abs(driven[-1]):.2f} m/s, ahead or back: it does not fall as the wall comes near, so "
            "the cart passes the place again and again"
        )
    if np.ptp(driven) < STANDS:
        nearest = np.min(distance[np.abs(speed) > STANDS])
        return (
            f"the command is {driven[-1]:.2f} m/s, and nothing from {nearest:.2f} m on: it does not fall as the wall "
            "comes near"
        )
    turns = np.flatnonzero(np.diff(np.sign(driven)))
    if len(turns) >= 3 and np.abs(driven[turns[1] :]).max() > 0.3 * FASTEST:
        return (
            f"the commands jump between {driven[turns[0] :].min():.2f} and {driven[turns[0] :].max():.2f} m/s near the "
            f"place, {len(turns)} times ahead and back: the speed is too high for the little that is left"
        )
    if abs(speed[-1]) > 2 * STANDS and np.all(left[-10:] * speed[-10:] > 0):
        return (
            f"it is still on its way: the last command is {speed[-1]:.2f} m/s with {abs(left[-1]):.2f} m left; it is "
            "too slow for that distance"
        )
    if abs(left[-1]) > CLOSE and np.all(np.abs(speed[-10:]) <= 2 * STANDS):
        return f"it has come to rest with {abs(left[-1]):.2f} m left: there, the command is {abs(speed[-1]):.2f} m/s"
    return ""


def of_kept_distances(times: np.ndarray, distance: np.ndarray, speed: np.ndarray, wanted: float) -> str:
    """Explain a driver that soon stops for good, far from where it should, while distances go on arriving."""
    driven = np.flatnonzero(np.abs(speed) > STANDS)
    if not len(driven):
        return ""
    first, last = driven[0], driven[-1]
    after = slice(last + 1, None)
    if (times[last] - times[first]) / 1e9 > 2 * OLDEST or (times[-1] - times[last]) / 1e9 < 4 * OLDEST:
        return ""
    if not np.all(np.abs(distance[after] - wanted) > 2 * CLOSE):
        return ""
    return (
        f"it drives for {(times[last] - times[first]) / 1e9:.1f} s, and then every command is zero although distances "
        "go on arriving: the distance that it uses, or its stamp, is not renewed, and is soon too old"
    )


def of_an_end(end: float, last: float, speed: float, conditions: list[Any]) -> str:
    """Explain commands that end [ns] long before the run does, with a speed [m/s] that the cart keeps."""
    if end - last < 1e9 or abs(speed) <= STANDS:
        return ""
    code = ", ".join(f"`{each['code']}` in line {each['line']}" for each in conditions)
    return f"no command comes after {last / 1e9:.1f} s, and the cart obeys the last one, {speed:.2f} m/s" + (
        f": publish a 0 as well; before the publish() of driver_node.py stand {code}" if code else ""
    )


def _drives(speed: np.ndarray, left: np.ndarray) -> bool:
    """Whether the commands are those of the driver as it was given, with `left` [m] to drive.

    Where the fastest speed cuts them off, they say nothing about the way that is left.
    """
    commands = np.clip(GAIN * left, -FASTEST, FASTEST)
    free = np.abs(commands) < FASTEST
    return _fits(speed, commands) and _fits(speed[free], commands[free])


def _adds_up(speed: np.ndarray, left: np.ndarray) -> bool:
    """Whether each command differs from the one before in proportion to what is left [m]."""
    steps, inside = np.diff(speed), np.abs(speed) < 0.98 * np.abs(speed).max()
    free = inside[1:] & inside[:-1] & (np.abs(left[1:]) > CLOSE)
    if free.sum() < FEWEST:
        return False
    shares = steps[free] / left[1:][free]
    usual = float(np.median(shares))
    return usual > 1e-3 and bool(np.mean(np.abs(shares - usual) < 0.2 * usual) > 0.7)


def _aim(distance: np.ndarray, speed: np.ndarray) -> float | None:
    """Return the distance at which the commands come to zero, if they fall in proportion to it; else None."""
    free = (np.abs(speed) < np.abs(speed).max() - STANDS) & (np.abs(speed) > STANDS)
    if free.sum() < FEWEST or np.ptp(distance[free]) < 4 * CLOSE or np.ptp(speed[free]) < 2 * STANDS:
        return None
    gain, offset = np.polyfit(distance[free], speed[free], 1)
    if gain <= 0 or not _fits(speed[free], gain * distance[free] + offset):
        return None
    return round(float(-offset / gain), 3) + 0.0  # no -0


def _fits(values: np.ndarray, others: np.ndarray) -> bool:
    """Whether nearly all values are close to others."""
    if len(values) < FEWEST:
        return False
    return bool(np.mean(np.abs(values - others) < CLOSE) >= SHARE)
