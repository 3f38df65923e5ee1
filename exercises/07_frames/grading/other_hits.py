"""Points that are other hits of their scan than the nearest, several for one scan, or rounded."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from .geometry import polar

if TYPE_CHECKING:
    from .checks import Scans
    from .geometry import Frame

CLOSE = 0.03  # [m]
SHARE = 0.9  # of the points


def valid(found: Scans) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Return the ranges [m] of each scan, NaN where a ray is not valid, and the angles [rad] of its rays."""
    for row, (low, high), (first, step) in zip(found.rows, found.limits, found.angles, strict=True):
        yield np.where((row > low) & (row < high), row, np.nan), first + np.arange(len(row)) * step


def hits_of(found: Scans) -> list[np.ndarray]:
    """Return all hits of each scan in the scanner's frame, (rays, 3) [m]; NaN for a ray without one."""
    return [np.stack([row * np.cos(at), row * np.sin(at), 0 * row], -1) for row, at in valid(found)]


def several(number: np.ndarray, times: np.ndarray, stamps: np.ndarray) -> str:
    """Return that scans got several points each, with the reason; empty if most got one.

    `times` are those of all points [ns], `stamps` those in their headers [s]. Points of one scan that come at one time
    are made by a loop over its rays; others answer a scan again that has its point.
    """
    if np.mean(number > 1) < 0.5:
        return ""
    usual = f"your node publishes about {np.median(number[number > 0]):.0f} points for each scan"
    rounds = np.unique(np.stack([times, np.round(stamps * 1e3)], 1), axis=0)
    if len(rounds) > 0.7 * len(times):
        return (
            f"{usual}, one after the other: one is asked for. A scan that has its point is done: take it out of those "
            "that wait, such as with remove() or popleft()"
        )
    return f"{usual}: one is asked for, the nearest hit, published once, after the loop over the rays"


def some_hit(found: Scans, wrong: np.ndarray, seen: np.ndarray) -> str:
    """Return that the points, `seen` (n, 3) in the scanner's frame, are hits of their scans, but not the nearest."""
    every = hits_of(found)
    off = [np.nanmin(np.linalg.norm(every[i] - seen[i], axis=1)) for i in wrong if not np.isnan(seen[i, 0])]
    if not off or np.mean(np.array(off) <= CLOSE / 2) < SHARE:
        return ""
    said = "hits of their scans, rightly transformed, but not the nearest ones"
    scans = [(hits, angles) for hits, (_, angles) in zip(every, valid(found), strict=True)]
    seen_at = np.degrees(np.arctan2(seen[wrong, 1], seen[wrong, 0]))
    half = np.degrees(found.angles[0, 1]) / 2  # of a ray
    low, high = np.nanmin(seen_at) - half, np.nanmax(seen_at) + half
    nearest = chosen(scans, within(low, high))
    if (
        high - low < 0.8 * np.degrees(np.ptp(scans[0][1]))
        and np.mean(np.linalg.norm(nearest - seen, axis=1)[wrong] <= CLOSE) >= SHARE
    ):
        return f"{said}: only rays from about {low:.0f} to {high:.0f} degrees were looked at, and all rays count"
    return f"{said}: another ray is chosen"


def chosen(scans: list[Any], measure: Callable[..., Any]) -> np.ndarray:
    """Return the hits (n, 3) [m] in the scanner's frame for which `measure` of (hits, angles, number) is smallest."""
    points = []
    for i, (hits, angles) in enumerate(scans):
        size = np.where(np.isnan(hits[:, 0]), np.inf, measure(hits, angles, i))
        ray = int(np.argmin(size))
        points.append(hits[ray] if np.isfinite(size[ray]) else np.full(3, np.nan))
    return np.array(points)


def within(low: float, high: float) -> Callable[..., Any]:
    """Return the measure of the nearest hit among rays between two angles [degrees]."""

    def measure(hits: np.ndarray, angles: np.ndarray, number: int) -> np.ndarray:
        inside = (np.degrees(angles) >= low) & (np.degrees(angles) <= high)
        return np.where(inside, np.linalg.norm(hits, axis=1), np.inf)

    return measure


def of_other_measures(found: Scans, scanner: Frame, mount: Frame) -> Iterator[tuple[str, np.ndarray]]:
    """Yield hits (n, 3) [m] in the scanner's frame that are nearest by another measure, or among other rays.

    `scanner` are its poses in odom, `mount` those on the robot.
    """

    def from_origin(frame: Frame, axes: list[int]) -> Callable[..., Any]:
        return lambda hits, angles, i: np.linalg.norm((hits @ frame.turn[i].T + frame.place[i])[:, axes], axis=1)

    measures = {
        "the hits nearest to the origin of odom, not to the scanner": from_origin(scanner, [0, 1]),
        "the hits nearest to the robot's middle, not to the scanner": from_origin(mount, [0, 1]),
        "the hits with the smallest |x| in the scanner's frame, not with the smallest range": (
            lambda hits, angles, i: np.abs(hits[:, 0])
        ),
        "the hits with the smallest |y| in the scanner's frame, not with the smallest range": (
            lambda hits, angles, i: np.abs(hits[:, 1])
        ),
        "the hits with the smallest x in the scanner's frame, not with the smallest range": (
            lambda hits, angles, i: hits[:, 0]
        ),
        "the hits with the smallest x ahead of the scanner, not with the smallest range": (
            lambda hits, angles, i: np.where(hits[:, 0] > 0, hits[:, 0], np.inf)
        ),
        "the hits whose rays are nearest to straight ahead, not with the smallest range": (
            lambda hits, angles, i: np.abs(angles)
        ),
    }
    scans = [(hits, angles) for hits, (_, angles) in zip(hits_of(found), valid(found), strict=True)]
    for words, measure in measures.items():
        yield words, chosen(scans, measure)
    sectors = [(-half, half) for half in (5, 10, 15, 20, 30, 45, 60, 90)]
    sectors += [(0, 180), (-180, 0), (0, 90), (-90, 0), (90, 180), (-180, -90)]
    for low, high in sectors:
        words = f"the nearest hit among the rays from {low} to {high} degrees only: all rays of the scan count"
        yield words, chosen(scans, within(low, high))
    yield "the second nearest hit, not the nearest", second(found)
    yield (
        "those of an index among the valid rays only, used as the number of a ray: they are not the same",
        shifted(found),
    )


def second(found: Scans) -> np.ndarray:
    points = []
    for hits in hits_of(found):
        distance = np.where(np.isnan(hits[:, 0]), np.inf, np.linalg.norm(hits, axis=1))
        points.append(hits[np.argsort(distance)[min(1, len(distance) - 1)]])
    return np.array(points)


def shifted(found: Scans) -> np.ndarray:
    """Return hits in the direction that the index of the nearest among the valid rays would have in the scan."""
    points = []
    for row, angles in valid(found):
        ranges = row[~np.isnan(row)]
        ray = int(np.argmin(ranges))
        points.append((ranges[ray] * np.cos(angles[ray]), ranges[ray] * np.sin(angles[ray]), 0.0))
    return np.array(points)


def rounded(truth: np.ndarray, hits: np.ndarray) -> Iterator[tuple[bool, str, np.ndarray]]:
    """Yield rounded points (n, 3) [m]: of `truth` in odom, of `hits` in the scanner's frame; and which of both."""
    distance, angle = np.linalg.norm(hits, axis=1), np.arctan2(hits[:, 1], hits[:, 0])
    changes: dict[str, Callable[[np.ndarray], np.ndarray]] = {"rounded": np.round, "cut off": np.trunc}
    for how, change in changes.items():
        for step, name in ((1.0, "whole metres"), (0.1, "one decimal")):
            yield True, f"{how} to {name}", change(truth / step) * step
            yield False, f"{how} to {name} before they are transformed", change(hits / step) * step
            range_ = change(distance / step) * step
            yield False, f"those of a range that is {how} to {name}", polar(range_, angle)
        for step, name in ((1.0, "whole radians"), (0.1, "tenths of a radian"), (np.pi / 180, "whole degrees")):
            yield False, f"those of an angle that is {how} to {name}", polar(distance, change(angle / step) * step)
