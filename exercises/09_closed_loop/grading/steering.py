"""What the commands of a wall follower depend on, found out from the run: `misconceptions.py` asks for it.

For each thing that a node may measure in a scan, the turning rates are predicted from those at other times at which
that thing was much the same (the nearest neighbours, as in k-NN regression). If the rates depend on it alone, the
prediction is right: its share of the variance that is explained, R squared, is near 1.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .wall import Run

NEIGHBOURS = 4
APART = 8  # scans between a scan and its neighbours: those beside it are alike whatever the node measures
SCALE, ASKED = 0.15, 0.05  # [m] or [rad], [m]: about as far as two measurements may differ
ALIKE = 2.5  # of those scales; what has no neighbour so near is left out
FEWEST = 40  # scans
NOTHING = 6.0  # [m] for a ray that hit nothing
LIMIT = 1.5  # [rad/s]
THICK = 0.04  # [m] ranges that are as near as the nearest one, with noise
EDGES = (-45, 0, 30, 50, 75, 90, 105, 130, 150)  # [degrees] of sectors that a node may look at


def measured(bearings: np.ndarray, ranges: np.ndarray) -> dict[str, np.ndarray]:
    """Return what a node may measure: by name, an array (scans, numbers); bearings grow from ahead to the side."""
    ranges = np.where(np.isfinite(ranges) & (ranges > 0.05), ranges, NOTHING)

    def nearest(chosen: np.ndarray) -> np.ndarray:
        return nearest_point(bearings[chosen], ranges[:, chosen])

    def towards(direction: float, width: float = 0.06) -> np.ndarray:
        off = np.abs(np.remainder(bearings - direction + np.pi, 2 * np.pi) - np.pi)
        return ranges[:, off < width].min(axis=1)[:, None]

    side, other = (bearings > -0.2) & (bearings < 2.5), (bearings < 0.2) & (bearings > -2.5)
    return {
        "right": nearest(side),
        "other side": nearest(other),
        "all around": nearest(np.abs(bearings) < 9),
        "distance alone": nearest(side)[:, :1],
        "beside": towards(np.pi / 2),
        "beside, two": np.hstack([towards(np.radians(75)), towards(np.radians(105))]),
        "beside, other": towards(-np.pi / 2),
        "ahead": towards(0, 0.3),
        "behind": towards(np.pi, 0.1),
        "mean": ranges[:, (bearings > 0.2) & (bearings < 2.8)].mean(axis=1)[:, None],
    }


def nearest_point(bearings: np.ndarray, ranges: np.ndarray) -> np.ndarray:
    """Return range and bearing of the nearest point, shape (scans, 2)."""
    least = ranges.min(axis=1)
    there = ranges < least[:, None] + THICK
    return np.stack([least, (there * bearings).sum(axis=1) / there.sum(axis=1)], axis=1)


def sector(
    bearings: np.ndarray, ranges: np.ndarray, rates: np.ndarray, asked: np.ndarray
) -> tuple[tuple[int, int], float]:
    """Return the sector (from, to) [degrees] whose nearest point, or distance, explains most, and the share of it."""
    ranges = np.where(np.isfinite(ranges) & (ranges > 0.05), ranges, NOTHING)
    best = (0, 0), 0.0
    for number, low in enumerate(EDGES):
        for high in EDGES[number + 1 :]:
            if high - low > 140:
                continue  # that is the side, or nearly
            chosen = (bearings >= np.radians(low)) & (bearings <= np.radians(high))
            point = nearest_point(bearings[chosen], ranges[:, chosen])
            share = max(explained(point, rates, asked), explained(point[:, :1], rates, asked))
            best = max(best, ((low, high), share), key=lambda each: each[1])
    return best


def explained(values: np.ndarray, rates: np.ndarray, asked: np.ndarray) -> float:
    """Return which share of the variance of turning rates [rad/s] some measured values (n, k) explain.

    `asked` is the distance [m] that the parameter asked for at each time, which nodes depend on as well.
    """
    if len(rates) < FEWEST or rates.var() < 1e-4:
        return 0.0
    points = np.hstack([values / SCALE, asked[:, None] / ASKED])
    squares = (points**2).sum(axis=1)
    away = squares[:, None] + squares[None] - 2 * points @ points.T  # squared distances
    number = np.arange(len(points))
    away[np.abs(number[:, None] - number) <= APART] = np.inf
    order = np.argpartition(away, NEIGHBOURS, axis=1)[:, :NEIGHBOURS]
    near = np.take_along_axis(away, order, axis=1).max(axis=1) < ALIKE**2
    if near.sum() < FEWEST or rates[near].var() < 1e-4:
        return 0.0
    off = rates[near] - rates[order[near]].mean(axis=1)
    return float(1 - (off**2).mean() / rates[near].var())


def follows(run: Run, times: np.ndarray, bearings: np.ndarray, ranges: np.ndarray) -> dict[str, Any]:
    """Return what the turning rates depend on: by name, the share of their variance that it explains."""
    heard, rates, asked = answered(run, times)
    if heard.sum() < FEWEST:
        return {}
    found = measured(bearings, ranges[heard])
    return {name: explained(values, rates, asked) for name, values in found.items()}


def lag(run: Run, times: np.ndarray, bearings: np.ndarray, ranges: np.ndarray) -> int:
    """Return how many commands late the answer to a scan comes: 1 if a timer runs before the scan is heard, else 0."""
    best = []
    for late in (0, 1):
        run.lag = late
        heard, rates, asked = answered(run, times)
        found = measured(bearings, ranges[heard])
        best.append(max(explained(found[name], rates, asked) for name in ("right", "other side", "beside", "ahead")))
    return int(1 - best[1] < 0.7 * (1 - best[0]))


def answered(run: Run, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return to which scans a command came, the turning rates [rad/s] towards the side, and the distances asked for."""
    signal = run.recording.signal("topics/cmd_vel/angular/z")
    index = np.searchsorted(signal.times / 1e9, times) + getattr(run, "lag", 0)
    heard = (index < len(signal.times)) & (times > 0.5)
    rates = np.clip(run.sign * signal.values[index[heard]], -LIMIT, LIMIT)
    return heard, rates, np.interp(times[heard], run.times, run.wanted)


def measures(run: Run, times: np.ndarray, bearings: np.ndarray, ranges: np.ndarray) -> str:
    """Return words on what the node measures, if it is clearly something else than it should be; else nothing."""
    share = follows(run, times, bearings, ranges)
    if not share:
        return ""
    right, other = share["right"], "right" if run.side == "left" else "left"
    beside, other_ray = max(share["beside"], share["beside, two"]), share["beside, other"]
    if share["other side"] > 0.7 and share["other side"] > max(right + 0.2, share["all around"] - 0.03, other_ray):
        return (
            f"angular.z follows the nearest point on the {other} of the robot, and side is {run.side!r}: the bearings "
            "of a scan grow to the left (counter-clockwise), ray i looks to angle_min + i * angle_increment"
        )
    if share["all around"] > 0.75 and share["all around"] > right + 0.2:
        return f"angular.z follows the nearest range of all directions: take the nearest one on the {run.side} side"
    if share["behind"] > 0.9 and share["behind"] > right + 0.2:
        return "angular.z follows the ray behind the robot: ray 0 looks to angle_min, which is -3.14, and not ahead"
    if other_ray > 0.85 and other_ray > right + 0.2:
        return (
            f"angular.z follows the ray on the {other} of the robot, and side is {run.side!r}: ray i looks to "
            "angle_min + i * angle_increment, and angle_min is -3.14, behind the robot"
        )
    if (
        share["distance alone"] > 0.95
        and _clearly(share["distance alone"], right)
        and share["distance alone"] >= beside
    ):
        return (
            "angular.z depends on the distance alone: only the distance is fed back, not the heading towards the wall, "
            "so the robot comes to the wanted distance at an angle, and overshoots; let the bearing of the nearest "
            "point, which should be abeam, count too"
        )
    if beside > 0.95 and _clearly(beside, right):
        return (
            f"angular.z follows the rays straight to the {run.side} alone: a wall ahead, or a corner, is not seen "
            "until it is beside the robot; take the nearest of all rays from ahead to behind on that side"
        )
    if share["ahead"] > 0.9 and share["ahead"] > right + 0.2:
        return f"angular.z follows the range ahead alone: the wall to be followed is on the {run.side}"
    if share["mean"] > 0.9 and share["mean"] > right + 0.1:
        return (
            f"angular.z follows the mean of the ranges on the {run.side}, which depends on all that is far away: the "
            "distance is the nearest of them"
        )
    heard, rates, asked = answered(run, times)
    (low, high), found = sector(bearings, ranges[heard], rates, asked) if right < 0.93 else ((0, 0), 0.0)
    if found > 0.9 and _clearly(found, right):
        return (
            f"angular.z follows the rays between about {low} and {high} degrees from ahead to the {run.side} only: the "
            "nearest point of the wall may be anywhere from ahead to behind on that side"
        )
    return ""


def signs(run: Run, times: np.ndarray, bearings: np.ndarray, ranges: np.ndarray) -> str:
    """Return words on a term of the turning rate with the wrong sign, by a linear fit; else nothing."""
    heard, rates, asked = answered(run, times)
    if heard.sum() < FEWEST:
        return ""
    point = measured(bearings, ranges[heard])["right"]
    error, away = point[:, 0] - asked, point[:, 1] - np.pi / 2
    clear = (np.abs(rates) < 0.95 * LIMIT) & (np.abs(error) < 0.6)
    if clear.sum() < FEWEST or min(error[clear].std(), away[clear].std()) < 0.02:
        return ""
    terms = np.stack([error[clear], away[clear], np.ones(clear.sum())], axis=1)
    gains = np.linalg.lstsq(terms, rates[clear], rcond=None)[0]
    left = rates[clear] - terms @ gains
    if 1 - left.var() / max(rates[clear].var(), 1e-9) < 0.7:
        return ""
    if gains[0] < -0.3:
        return (
            f"the distance is fed back with the wrong sign: where the robot is too far from its wall ({run.side}), it "
            "turns away from it, and where it is too near, towards it"
        )
    if gains[1] < -0.3:
        return (
            "the heading is fed back with the wrong sign: where the nearest point of the wall is ahead of abeam, the "
            "robot must turn away from the wall, and it turns towards it"
        )
    return ""


def _clearly(share: float, other: float) -> bool:
    """Return whether one share leaves less than half as much unexplained as another."""
    return 1 - share < 0.5 * (1 - other)
