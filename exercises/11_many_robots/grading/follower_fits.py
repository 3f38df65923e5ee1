"""What a follower with a common misconception would have sent, compared with the commands it did send.

Each candidate is a quantity that such a node computes from the two odometries it hears. A node that steers by it sends
a multiple of it, up to its limits: a straight line through the commands between the limits tells whether it fits.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from gz_course.grader.record.reading import Recording

from . import follower_lags, follower_origins
from .follower_origins import GAP

FEWEST = 8  # commands; fewer may fit a line by chance
DELAYS = (0, 50_000_000, 100_000_000)  # [ns] between what a node has heard and what it sends: its timer may fire first
FITS = 0.99  # of the variance of the commands that a line must explain
BETTER = 0.5  # of what the right quantity leaves unexplained: so much it must explain
EDGE = 0.02  # [m/s, rad/s] from the largest command: nearer ones are at the limit
LENGTH = 0.4  # [m] of a robot
WIDE = 0.15  # [m] by which a gap differs from the right one
SHARE = 0.9  # of the commands
ASTRAY = 0.05  # [rad] from the direction in which a follower does not turn: more is another angle
TRACKED = 0.3  # [rad] from the direction of the robot in front: who stays nearer turns to it
PLACES = "each odometry begins where its own robot began, and the robot in front began 1.2 m ahead"
FASTEST = 5.0  # [m/s] no sensible speed of such a robot is larger
VARIES = 0.03  # least standard deviation of commands that can be fitted


@dataclass(frozen=True)
class Heard:
    """Commands of a follower, and the odometry it had when it sent each: its own and that of the robot in front."""

    linear: np.ndarray
    angular: np.ndarray
    x: np.ndarray
    y: np.ndarray
    heading: np.ndarray
    front_x: np.ndarray
    front_y: np.ndarray
    front_heading: np.ndarray
    front_linear: np.ndarray
    front_angular: np.ndarray

    @property
    def ahead(self) -> np.ndarray:
        """Where the robot in front is along x [m]; its odometry begins 1.2 m ahead."""
        return self.front_x + GAP - self.x

    @property
    def aside(self) -> np.ndarray:
        return self.front_y - self.y

    @property
    def distance(self) -> np.ndarray:
        return np.hypot(self.ahead, self.aside)


def heard(recording: Recording, name: str, front: str) -> list[Heard]:
    """Return what a follower sent and what it had heard by then, for each delay; empty if it sent too little."""
    base = f"topics/{name}/cmd_vel"
    times = np.asarray(recording.signal(f"{base}/linear/x").times)
    signals = {}
    for key, robot in (("", name), ("front_", front)):
        for field, path in (
            *(("x", "pose/pose/position/x"), ("y", "pose/pose/position/y")),
            *(("z", "pose/pose/orientation/z"), ("w", "pose/pose/orientation/w")),
            *(("linear", "twist/twist/linear/x"), ("angular", "twist/twist/angular/z")),
        ):
            signals[key + field] = recording.signal(f"topics/{robot}/odom/{path}")
    if len(times) < FEWEST or any(not len(signal) for signal in signals.values()):
        return []
    known = times >= max(signal.times[0] for signal in signals.values()) + max(DELAYS)
    linear, angular = (recording.signal(f"{base}/{path}").values[known] for path in ("linear/x", "angular/z"))
    if len(linear) < FEWEST:
        return []
    found = []
    for delay in DELAYS:
        at = {}
        for key, signal in signals.items():
            before = np.searchsorted(signal.times, times[known] - delay, side="right") - 1
            at[key] = signal.values[before]
        heading, front_heading = (2 * np.arctan2(at[f"{key}z"], at[f"{key}w"]) for key in ("", "front_"))
        found.append(
            Heard(
                *(linear, angular, at["x"], at["y"], heading),
                *(at["front_x"], at["front_y"], front_heading, at["front_linear"], at["front_angular"]),
            )
        )
    return found


def wrapped(angle: np.ndarray) -> np.ndarray:
    return np.arctan2(np.sin(angle), np.cos(angle))


def line(quantity: np.ndarray, commands: np.ndarray) -> tuple[float, float, float] | None:
    """Return slope, offset and fit (0..1) of the commands between the limits over a quantity; None without enough."""
    low, high = commands.min(), commands.max()
    between = (commands > low + EDGE) & (commands < high - EDGE)
    if between.sum() < FEWEST or commands[between].std() < VARIES or quantity[between].std() < 1e-6:
        return None
    x, y = quantity[between], commands[between]
    slope, offset = np.polyfit(x, y, 1)
    rest = y - (slope * x + offset)
    return float(slope), float(offset), float(1 - rest.var() / y.var())


def copied(commands: np.ndarray, speeds: np.ndarray) -> bool:
    """Return whether commands that change are the speeds of the robot in front."""
    return np.ptp(commands) > 5 * EDGE and np.mean(np.abs(commands - speeds) < EDGE) > SHARE


def speed(every: list[Heard]) -> str:
    """Return which wrong quantity the speed of the follower is made of; empty if none fits."""
    v = every[0].linear
    if np.ptp(v) < EDGE:
        return _constant(every[0])
    if (fastest := float(np.abs(v).max())) > FASTEST:
        return f"it sends speeds of up to {fastest:.0f} m/s: linear.x is in metres per second, and robot1 drives 0.5"
    if any(copied(v, h.front_linear) for h in every):
        return "its speed is that of the robot in front, whatever the distance"
    if words := follower_lags.exchanged(every, line) or follower_lags.held_by_the_front(every):
        return words
    if words := _summed(every):
        return words
    right = closest([(h.distance, "") for h in every], v)
    fits = right if right is not None and right[2] > FITS else None
    if fits is not None and fits[0] > 0 and abs(-fits[1] / fits[0] - GAP) < WIDE:
        return _pauses(every) or _of_the_gap(v, *fits[:2])
    other = follower_origins.other_places(every, line, right[2] if right is not None else 0.0)
    other = other or follower_origins.begun_elsewhere(every, line)
    other = other or follower_origins.to_the_place(every, line, right[2] if right is not None else 0.0)
    if not other and not follower_origins.to_behind(every, line):
        other = best([each for h in every for each in _lengths(h)], v, right)
    return other or _pauses(every) or (_of_the_gap(v, *fits[:2]) if fits is not None else _limits(v))


def seen_elsewhere(every: list[Heard]) -> str:
    """Return where a follower that never drives ahead takes the robot in front to be; empty if that is not known.

    With a speed of zero only the sides to which it turns can tell.
    """
    if every[0].linear.max() > EDGE:
        return ""
    errors = [wrapped(np.arctan2(h.aside, h.ahead) - h.heading) for h in every]
    right = max(sides(error, h.angular) for error, h in zip(errors, every, strict=True))
    if every[0].angular.any() and np.mean(np.abs(errors[0]) < TRACKED) > SHARE:
        return ""
    for h in every:
        behind = np.arctan2(h.aside, h.front_x - GAP - h.x) - h.heading
        exchanged = np.arctan2(-h.aside, h.x + GAP - h.front_x) - h.front_heading
        if right < SHARE <= sides(exchanged, h.angular):
            return (
                "it takes its own odometry for that of the robot in front, and that one for its own: the two "
                "subscriptions, or their callbacks, are exchanged"
            )
        if right < SHARE <= sides(behind, h.angular):
            return (
                "it looks for the robot in front 1.2 m too far behind: that one began 1.2 m ahead, so its place is "
                "front.x + 1.2 - own.x"
            )
    if not every[0].angular.any() and not every[0].linear.any() and (np.abs(every[0].aside) > WIDE).sum() >= FEWEST:
        return (
            "every command is zero, in linear.x and in angular.z, although the robot in front drives ahead and to the "
            "side: so it is with a node that does not see that one move, or does not send the numbers it has computed"
        )
    return ""


def sides(angle: np.ndarray, commands: np.ndarray) -> float:
    """Return the share of the commands that turn to the side of an angle, where that is not nearly ahead."""
    angle = wrapped(angle)
    clear = (np.abs(angle) > ASTRAY) & (np.abs(angle) < np.pi - ASTRAY)
    if clear.sum() < FEWEST:
        return 0.0
    return float(np.mean(np.sign(angle[clear]) == np.sign(commands[clear])))


def _lengths(h: Heard) -> Iterator[tuple[np.ndarray, str]]:
    for length in (np.hypot(h.front_x, h.front_y), np.hypot(h.front_x + GAP, h.front_y)):
        yield length, "its speed depends on the place of the robot in front alone: its own place is not subtracted"
    yield (
        np.hypot(h.front_x - h.x, h.front_y - h.y),
        f"it falls behind, because the distance that it keeps is wrong: {PLACES}",
    )
    yield h.ahead, "its speed depends on the distance along x only, not on the distance to the robot in front"
    yield h.front_x - h.x, f"its speed depends on the difference of the two x only, and {PLACES}"
    yield (
        np.hypot(h.front_x - h.x, h.front_y + GAP - h.y),
        "it adds the 1.2 m to y: the robot in front began 1.2 m ahead, along x",
    )
    yield (
        np.hypot(h.front_linear + GAP - h.x, h.y),
        "it takes the speed of the robot in front, twist, for its place, which is pose.pose.position",
    )
    yield (
        np.hypot(h.front_y - h.x, h.front_x + GAP - h.y),
        "it exchanges x and y of the robot in front",
    )
    yield np.abs(h.ahead) + np.abs(h.aside), "it adds the distances along x and y: the distance is hypot(x, y)"


def _pauses(every: list[Heard]) -> str:
    """Return that many commands are zero although the follower is behind; empty if they are few, or most."""
    distance = np.min([h.distance for h in every], axis=0)
    zero = np.abs(every[0].linear) < 1e-6
    if zero.all():
        return ""
    far = distance > GAP + 2 * WIDE
    if far.sum() >= FEWEST and np.mean(zero[far]) > 0.2 and (why := follower_origins.drives_from(every)):
        return f"{100 * np.mean(zero[far]):.0f} % of its speeds are zero although it is behind: {why}"
    behind = distance > max(GAP + WIDE, np.median(distance[~zero]))  # it drives when it is nearer
    if behind.sum() < FEWEST or not 0.2 < np.mean(zero[behind]) < SHARE or np.sum(~zero & behind) < 3:
        return ""
    return (
        f"{100 * np.mean(zero[behind]):.0f} % of its speeds are zero although it is behind: the condition under which "
        "it drives seldom holds"
    )


def _summed(every: list[Heard]) -> str:
    """Return that a speed is a sum over all distances: its changes, not the speed, go with the distance."""
    changes, v = np.diff(every[0].linear), every[0].linear
    free = (v > v.min() + EDGE) & (v < v.max() - EDGE)
    between = free[1:] & free[:-1]  # a sum beyond the limit is not seen
    if between.sum() < FEWEST or np.ptp(changes[between]) < VARIES:
        return ""
    for h in every:
        if np.ptp(h.distance[1:][between]) < VARIES:
            continue
        slope, offset = np.polyfit(h.distance[1:][between], changes[between], 1)
        rest = changes[between] - (slope * h.distance[1:][between] + offset)
        if slope > 0 and 1 - rest.var() / changes[between].var() > FITS and abs(-offset / slope - GAP) < WIDE:
            return (
                "its speed is a sum: each command adds to the one before what the distance asks for, so it swings "
                "about the gap; the speed itself is a number times distance - gap"
            )
    return ""


def _constant(h: Heard) -> str:
    v = float(h.linear[0])
    if abs(v) < EDGE:
        if min(h.distance.max(), np.hypot(h.front_x - h.x, h.front_y - h.y).max()) < GAP + WIDE:
            return ""
        return (
            f"it sends no speed above zero, even when it is {h.distance.max():.1f} m behind: that is so, among others, "
            "with a speed made of gap - distance, where it is distance - gap, with a condition that holds only when it "
            "is near, and with a place of the robot in front that is too far behind"
        )
    return f"it sends linear.x {v:.2f} m/s all the time, whatever the distance is"


def _of_the_gap(v: np.ndarray, slope: float, offset: float) -> str:
    """Return what is wrong with a speed that is a line over the distance: its sign, the gap it keeps, or its slope."""
    if slope < 0:
        return "it is slower the farther it is behind: the sign of its speed is wrong; it is distance - gap"
    gap = -offset / slope
    if abs(gap) < 0.1:
        return "its speed is the distance times a number, so it drives on where the distance is the gap: subtract 1.2 m"
    if abs(gap - GAP - LENGTH) < WIDE / 2:
        return (
            f"its speed is zero at a distance of {gap:.2f} m, which is the gap and the length of a robot: 1.2 m are "
            "from centre to centre, not from the front of one robot to the back of the other"
        )
    if abs(gap - GAP) > WIDE:
        return f"its speed is zero at a distance of {gap:.2f} m, so that is the gap it keeps, not 1.2 m"
    if slope < 0.8:
        return (
            f"its speed is only {slope:.2f} times the distance that is too much, so it stays {0.5 / slope:.1f} m "
            "farther behind a robot of 0.5 m/s: its gain is too small"
        )
    return _limits(v)


def _limits(v: np.ndarray) -> str:
    fastest, slowest = float(v.max()), float(v.min())
    if fastest <= 1e-6 and slowest < -EDGE:
        return "it drives backwards: all its speeds are below zero"
    if (np.abs(v - fastest) < 1e-6).sum() >= FEWEST and fastest < 0.5 - EDGE:
        return f"it never drives faster than {fastest:.2f} m/s, and robot1 drives 0.5 m/s"
    if (np.abs(v - slowest) < 1e-6).sum() >= FEWEST and slowest > EDGE:
        return f"it never drives slower than {slowest:.2f} m/s, so it does not stop at the gap"
    return ""


def closest(candidates: list[Any], commands: np.ndarray) -> tuple[float, float, float] | None:
    """Return the line that fits best; None if nothing can be fitted."""
    return max(filter(None, (line(quantity, commands) for quantity, _ in candidates)), default=None, key=lambda f: f[2])


def best(
    candidates: list[Any], commands: np.ndarray, right: tuple[float, float, float] | None, most: float = np.inf
) -> str:
    """Return the words of the candidate that fits best, if it fits, and better than the right quantity.

    `most` is how far from zero a quantity may be for which nothing is commanded.
    """
    fits = [(line(quantity, commands), words) for quantity, words in candidates]
    found = [(fit[2], words) for fit, words in fits if fit is not None and fit[0] > 0 and abs(fit[1]) < most * fit[0]]
    best = max(found, default=(0.0, ""), key=lambda each: each[0])
    least = max(FITS, right[2] + BETTER * (1 - right[2])) if right is not None else FITS
    return best[1] if best[0] > least else ""
