"""Where points lie if they are those of other rays, or of another heading; and in what wrong points are right."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .geometry import about_z, polar

if TYPE_CHECKING:
    from .checks import Scans

CLOSE = 0.03  # [m]
SAME_WAY = 0.03  # [rad]
SHARE = 0.9  # of the points
SOME_RAYS = 6
SIGNS = (1, -1, -1), (-1, 1, -1), (-1, -1, 1), (1, 1, 1)  # of the diagonal, for x, y, z, w


def of_other_headings(turn: np.ndarray, hits: np.ndarray, given: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    """Yield hits (n, 3) [m] turned about z by what is not the heading of the rotations (n, 3, 3).

    A quaternion and its opposite are the same rotation: of the points of both, those near the given ones (n, 3) count.
    """
    heading = np.arctan2(turn[:, 1, 0], turn[:, 0, 0])
    right = "the heading is 2 * atan2(q.z, q.w)"
    signs = (np.sin(heading / 2), np.cos(heading / 2)), (-np.sin(heading / 2), -np.cos(heading / 2))
    angles: dict[str, Callable[[np.ndarray, np.ndarray], np.ndarray]] = {
        f"turned by q.z as if it were an angle: {right}": lambda z, w: z,
        f"turned by q.w as if it were an angle: {right}": lambda z, w: w,
        f"turned by 2 * q.z: {right}": lambda z, w: 2 * z,
        f"turned by half the heading: {right}; a quaternion turns a vector as q * v * conjugate(q)": np.arctan2,
        f"turned by 2 * q.z * q.w, which is about the sine of the heading, not the heading: {right}": lambda z, w: (
            2 * z * w
        ),
        f"turned by asin(q.z): {right}": lambda z, w: np.arcsin(z),
        f"turned by acos(q.w): {right}": lambda z, w: np.arccos(w),
        f"turned by 2 * acos(q.w), which has lost its sign: {right}": lambda z, w: 2 * np.arccos(w),
        f"turned by 2 * asin(q.z), which is right to 180 degrees of q.w > 0 only: {right}": lambda z, w: (
            2 * np.arcsin(z)
        ),
        "turned by the heading in degrees: cos() and sin() take radians": lambda z, w: np.degrees(2 * np.arctan2(z, w)),
        f"turned by an angle whose z and w are exchanged: {right}": lambda z, w: 2 * np.arctan2(w, z),
    }
    for words, angle in angles.items():
        one, other = (np.einsum("nij,nj->ni", about_z(angle(z, w)), hits) for z, w in signs)
        nearer = np.linalg.norm(one - given, axis=1) <= np.linalg.norm(other - given, axis=1)
        yield words, np.where(nearer[:, None], one, other)


def _quaternions(turn: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the quaternions x, y, z, w, each (n,), of rotations (n, 3, 3)."""
    squares = [1 + turn[:, 0, 0] * a + turn[:, 1, 1] * b + turn[:, 2, 2] * c for a, b, c in SIGNS]
    x, y, z, w = (np.sqrt(np.maximum(square, 0)) / 2 for square in squares)
    x = np.copysign(x, turn[:, 2, 1] - turn[:, 1, 2])
    y = np.copysign(y, turn[:, 0, 2] - turn[:, 2, 0])
    z = np.copysign(z, turn[:, 1, 0] - turn[:, 0, 1])
    return x, y, z, w


def of_other_formulas(turn: np.ndarray, hits: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    """Yield hits (n, 3) [m] turned by a formula with one slip: v + 2 w (u x v) + 2 u x (u x v) is the right one.

    Source: https://en.wikipedia.org/wiki/Quaternions_and_spatial_rotation (Rodrigues' rotation of a vector).
    """
    *axis, w = _quaternions(turn)
    u = np.stack(axis, -1)
    once = np.cross(u, hits)
    twice, w = np.cross(u, once), w[:, None]
    right = "a quaternion turns v to v + 2 w (u x v) + 2 u x (u x v), where u is (x, y, z)"
    for points in (hits + w * once + twice, hits + 2 * w * once + twice, hits + w * once + 2 * twice):
        yield f"turned by a formula with a wrong factor or sign: {right}", points
    yield f"turned by a formula that lacks u x (u x v): {right}", hits + 2 * w * once
    yield f"turned by a formula that lacks w (u x v): {right}", hits + 2 * twice


def of_other_quaternions(
    turn: np.ndarray,
) -> Iterator[tuple[str, tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]]]:
    """Yield quaternions (x, y, z, w), each (n,), that are not those of the rotations (n, 3, 3)."""
    x, y, z, w = _quaternions(turn)
    words = "those of a quaternion in another order: ROS has x, y, z, w"
    yield words, (w, x, y, z)
    yield words, (y, z, w, x)
    yield words, (z, y, x, w)


def of_other_matrices(turn: np.ndarray, hits: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    """Yield hits (n, 3) [m] turned by the heading of the rotations (n, 3, 3) with one slip in the matrix."""
    heading = np.arctan2(turn[:, 1, 0], turn[:, 0, 0])
    c, s = np.cos(heading), np.sin(heading)
    x, y, z = hits.T
    right = "x is x * cos - y * sin, y is x * sin + y * cos"
    rows = {
        "a sign in x": (c * x + s * y, s * x + c * y),
        "a sign in y": (c * x - s * y, -s * x + c * y),
        "the sign of y * cos": (c * x - s * y, s * x - c * y),
        "the sign of x * cos": (-c * x - s * y, s * x + c * y),
        "sin and cos, which are exchanged": (s * x - c * y, c * x + s * y),
    }
    for words, (across, along) in rows.items():
        yield f"turned by a matrix that is wrong in {words}: {right}", np.stack([across, along, z], -1)


def of_other_rays(found: Scans) -> Iterator[tuple[str, np.ndarray]]:
    """Yield points in the scanner's frame that take another ray, or another direction for the ray."""
    first, step = found.angles.T
    distance = np.linalg.norm(found.hits, axis=-1)
    around = 2 * np.pi * found.rays / np.array([len(row) for row in found.rows])
    angle = first + found.rays * step
    yield "off by angle_min: the angle of a ray is angle_min + i * angle_increment", polar(distance, found.rays * step)
    yield "those of an angle in degrees: cos() and sin() take radians", polar(distance, np.degrees(angle))
    yield "on the other side: angles grow to the left, y is range * sin(angle)", polar(distance, -angle)
    yield "those with sin and cos exchanged: x is range * cos(angle)", polar(distance, np.pi / 2 - angle)
    yield "those of rays all around: use angle_min and angle_increment", polar(distance, around)
    yield "those of rays all around, from -pi on: use angle_min and angle_increment", polar(distance, around - np.pi)
    both = "those with x and y alike: x is range * cos(angle), and y is range * sin(angle)"
    for part in (np.cos(angle), np.sin(angle)):
        yield both, np.stack([distance * part, distance * part, 0 * distance], -1)
    count = np.array([len(row) for row in found.rows])
    steps = found.rays * step * (count - 1) / count
    yield (
        "those of a step of (angle_max - angle_min) / n: n rays have n - 1 steps between them",
        polar(distance, first + steps),
    )
    words = "those of angles that were divided by 57.3 once more: angle_min and angle_increment are in radians already"
    yield words, polar(distance, np.radians(angle))
    best = np.array([int(np.argmin(distance[: i + 1])) for i in range(len(distance))])
    words = "the nearest hits of all scans so far: begin a new search in each scan"
    for direction in (angle[best], angle, first):
        yield words, polar(distance[best], direction)
    words = "those of an angle that grows by more than angle_increment from ray to ray: angle_min counts once only"
    yield words, polar(distance, found.rays * (first + step))
    yield words, polar(distance, found.rays * first)
    yield "those of a ray's number as its angle: angle_increment is missing", polar(distance, first + found.rays)
    numbers = np.radians(found.rays)
    yield "those of a ray's number as its angle in degrees: use angle_min and angle_increment", polar(distance, numbers)
    yield "those of a ray's number in degrees: use angle_increment", polar(distance, first + numbers)
    yield "off by one ray: their angle is that of the ray before", polar(distance, angle - step)
    yield "off by one ray: their angle is that of the next ray", polar(distance, angle + step)
    whole = 2 * np.pi / np.array([len(row) for row in found.rows])
    words = "those of a step of 2 * pi / n between the rays, as if they went all around: use angle_increment"
    yield words, polar(distance, first + found.rays * whole)
    yield (
        "those of angles that count down from angle_max: they begin at angle_min",
        polar(distance, first + (np.array([len(row) for row in found.rows]) - 1 - found.rays) * step),
    )
    yield (
        "off by the whole angle of a scan: their angle is angle_max + i * angle_increment",
        polar(distance, first + (np.array([len(row) for row in found.rows]) - 1 + found.rays) * step),
    )
    yield (
        "those of an angle_increment in degrees: it is in radians already",
        polar(distance, first + found.rays * np.radians(step)),
    )
    rank = np.array([np.sum(row < away) for row, away in zip(found.rows, distance - CLOSE / 10, strict=True)])
    words = "in the direction of the first ray: their angle is angle_min, whichever ray is the nearest"
    if rank.any():
        words = "those of a rank among sorted ranges: sorting loses the numbers of the rays"
    yield words, polar(distance, first + rank * step)
    yield "those of the nearest distance, drawn straight ahead of the scanner", polar(distance, 0 * angle)
    valid = [
        np.where((row > low) & (row < high), row, np.nan)
        for row, (low, high) in zip(found.rows, found.limits, strict=True)
    ]
    means = np.array([np.nanmean(row) for row in valid])
    yield "at the average distance of all hits, not at that of the nearest", polar(means, angle)
    others: dict[str, Callable[[np.ndarray], Any]] = {
        "the farthest hit, not the nearest": np.nanargmax,
        "the hit of the first valid ray, not the nearest": lambda row: np.flatnonzero(~np.isnan(row))[0],
        "the hit of the last valid ray, not the nearest": lambda row: np.flatnonzero(~np.isnan(row))[-1],
        "the hit of the ray in the middle, not the nearest": lambda row: len(row) // 2,
    }
    for words, ray_of in others.items():
        rays = np.array([ray_of(row) for row in valid])
        yield words, polar(np.array([row[i] for row, i in zip(valid, rays, strict=True)]), first + rays * step)
    every = [polar(row, a + np.arange(len(row)) * b) for row, a, b in zip(valid, first, step, strict=True)]
    yield "the middle of all hits, not the nearest", np.array([np.nanmean(points, 0) for points in every])


def _line_of_angles(angles: np.ndarray, rays: np.ndarray, first: float, step: float) -> str:
    """Return that the angles [rad] of points are a + b * i for the ray i, with which a and b; empty if they are not."""
    if len(np.unique(rays)) < SOME_RAYS or np.ptp(rays) * step < 0.5:
        return ""
    slopes = np.linspace(-3 * step, 3 * step, 2401)
    off = np.exp(1j * (angles[:, None] - slopes * rays[:, None]))
    fits = np.abs(off.mean(axis=0))
    best = int(np.argmax(fits))
    start = float(np.angle(off[:, best].mean()))
    apart = np.abs(np.angle(off[:, best] * np.exp(-1j * start)))
    if np.mean(apart <= SAME_WAY) < SHARE:
        return ""
    return (
        f"at the angle {start:.2f} {'-' if slopes[best] < 0 else '+'} {abs(slopes[best]):.4f} * i for the ray i, as "
        f"computed from the points; it should be angle_min + i * angle_increment, {first:.2f} + {step:.4f} * i here"
    )


def apart(
    points: np.ndarray,
    truth: np.ndarray,
    seen: np.ndarray,
    hits: np.ndarray,
    step: float,
    rays: Sequence[int] | np.ndarray = (),
    first: float = 0.0,
) -> str:
    """Return in what wrong points are right, as the end of "your points are ..."; empty if in nothing.

    `points` and `truth` are in odom, `seen` and `hits` the same in the scanner's frame, all (n, 3) [m]; `step` is the
    angle between two rays, `first` that of the first one [rad], and `rays` the numbers of the rays of the hits.
    """
    there = ~np.isnan(points[:, 0])
    numbers = np.asarray(rays)[there] if len(rays) else np.zeros(0)
    points, truth, seen, hits = points[there], truth[there], seen[there], hits[there]
    shift, factors = np.median(points - truth, 0), np.linalg.norm(seen, axis=1) / np.linalg.norm(hits, axis=1)
    angles = np.arctan2(seen[:, 1], seen[:, 0]) - np.arctan2(hits[:, 1], hits[:, 0])
    angles = np.remainder(angles + np.pi, 2 * np.pi) - np.pi
    off = np.abs(points - truth) <= CLOSE
    same = ("x", "y", "z", "x and y")
    axes = [name for name, each in zip(same, (*off.T, off[:, 0] & off[:, 1]), strict=True) if each.mean() >= SHARE]
    if np.mean(np.linalg.norm(points - truth - shift, axis=1) <= CLOSE) >= SHARE:
        return f"all shifted by the same way in odom, ({', '.join(f'{v:.2f}' for v in shift)}) m"
    own = np.median(seen - hits, 0)
    if np.mean(np.linalg.norm(seen - hits - own, axis=1) <= CLOSE) >= SHARE:
        said = ", ".join(f"{v:.2f}" for v in own)
        return (
            f"all shifted by the same way in the scanner's frame, ({said}) m: there a hit is at range * cos(angle), "
            "range * sin(angle), 0, and nothing is added; the transform holds the mount"
        )
    if np.mean(np.abs(np.linalg.norm(seen, axis=1) - np.linalg.norm(hits, axis=1)) <= CLOSE) >= SHARE:
        usual = float(np.median(angles))
        if np.mean(np.abs(angles - usual) <= SAME_WAY) >= SHARE:
            steps, degrees = usual / step, float(np.degrees(usual))
            whole = (
                abs(steps - round(steps)) < 0.1 and abs(steps) >= 1 and abs(degrees - 45 * round(degrees / 45)) > 0.5
            )
            why = (
                f", {abs(round(steps))} rays: the number of a ray is counted from the first one of ranges, also where "
                "only a part of them is looked at"
            )
            return (
                f"as far from the scanner as the hits, in directions that are {degrees:.0f} degrees off"
                f"{why if whole else ''}"
            )
        flat = np.mean(np.abs(seen[:, 2]) <= CLOSE) >= SHARE
        if (
            flat
            and len(numbers)
            and (line := _line_of_angles(np.arctan2(seen[:, 1], seen[:, 0]), numbers, first, step))
        ):
            return f"as far from the scanner as the hits, {line}"
        return "as far from the scanner as the hits, in other directions: the angle, or a rotation, is wrong"
    if np.mean(np.abs(angles) <= SAME_WAY) >= SHARE and "z" in axes:
        usual = float(np.median(factors))
        times = f", {usual:.2f} times as far" if np.mean(np.abs(factors / usual - 1) <= 0.02) >= SHARE else ""
        more = np.linalg.norm(seen, axis=1) - np.linalg.norm(hits, axis=1)
        if np.mean(np.abs(more - np.median(more)) <= CLOSE / 2) >= SHARE:
            times = f", all {abs(np.median(more)):.2f} m too {'far' if np.median(more) > 0 else 'near'}"
        return f"in the right directions from the scanner, but at other distances{times}"
    if "z" not in axes and axes and axes[-1] == "x and y":
        distance, height = np.linalg.norm(hits, axis=1), float(np.median(points[:, 2]))
        if np.mean(np.abs(points[:, 2] - truth[:, 2] - distance) <= CLOSE) >= SHARE:
            return "right in x and y, but z holds the range: the scanner's plane has z = 0 in its own frame"
        same = np.ptp(points[:, 2]) <= CLOSE
        return f"right in x and y, but not in z, {f'always {height:.2f}' if same else f'such as {points[0, 2]:.2f}'} m"
    return f"right in {axes[-1]} only" if axes else ""
