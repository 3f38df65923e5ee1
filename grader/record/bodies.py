"""The bodies of the world, read from a recording: their outline from above and their pose over time.

Reports draw them. This is the inverse of `scene.py`; a shape becomes the convex hull of its footprint.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gz_course.grader.record.reading import Poses, Recording

SHAPES = ("Boxes3D", "Cylinders3D", "Capsules3D", "Ellipsoids3D", "Mesh3D")
MOST_CORNERS = 4096  # of a surface; more make no visible difference
FLAT = 0.005  # [m] a shape thinner than this that lies on the ground is the ground
ROUND = 24  # corners of a drawn circle


@dataclass(frozen=True)
class Body:
    """One visual: its corners `corners` (n, 3) [m] in its own frame, and its chain of poses, outermost first."""

    entity: str
    model: str
    corners: np.ndarray
    rgba: tuple[int, int, int, int]
    chain: tuple[Poses, ...]

    @property
    def moves(self) -> bool:
        """Whether it belongs to a model whose pose was recorded over time."""
        return any(len(poses.times) > 1 for poses in self.chain)

    def at(self, time_ns: int) -> np.ndarray:
        """Return the corners (n, 3) [m] in the world frame at a time [ns]."""
        return placed(self.corners, self.chain, time_ns)


def bodies(recording: Recording) -> list[Body]:
    """Return every visual of the world except the ground, sorted by name."""
    found = []
    for shape in SHAPES:
        for entity in recording.entities("world", shape):
            facts = recording.static(entity)
            corners = _corners(shape, facts)
            chain = chain_of(recording, entity)
            if len(corners) and not _is_ground(corners):
                found.append(Body(entity, entity.split("/")[1], corners, _rgba(shape, facts), chain))
    return sorted(found, key=lambda body: body.entity)


def chain_of(recording: Recording, entity: str) -> tuple[Poses, ...]:
    """Return the poses of an entity and of its parents, outermost first."""
    parts = entity.split("/")
    chain = [recording.poses("/".join(parts[:n])) for n in range(1, len(parts) + 1)]
    return tuple(poses for poses in chain if poses is not None)


def placed(points: np.ndarray, chain: tuple[Poses, ...], time_ns: int) -> np.ndarray:
    """Transform points (n, 3) from the innermost frame of a chain to the world frame, at a time [ns]."""
    for poses in reversed(chain):
        index = max(int(np.searchsorted(poses.times, time_ns, side="right")) - 1, 0)
        points = points @ rotation(poses.quaternions[index]).T + poses.positions[index]
    return points


def hull(points: np.ndarray) -> np.ndarray:
    """Return the convex hull (m, 2) of points (n, 2), counter-clockwise.

    Source: A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions" (monotone chain).
    """
    rows = np.unique(np.round(points, 6), axis=0).tolist()
    if len(rows) < 3:
        return np.asarray(rows, dtype=float).reshape(-1, 2)

    def half(ordered: list[list[float]]) -> list[list[float]]:
        line: list[list[float]] = []
        for x, y in ordered:
            while len(line) > 1:
                (ax, ay), (bx, by) = line[-2], line[-1]
                if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0:
                    break
                line.pop()
            line.append([x, y])
        return line[:-1]

    return np.asarray(half(rows) + half(rows[::-1]), dtype=float)


def _corners(shape: str, facts: dict) -> np.ndarray:
    if shape == "Mesh3D":
        corners = np.asarray(facts.get("Mesh3D:vertex_positions", []), dtype=float).reshape(-1, 3)
        return corners[:: len(corners) // MOST_CORNERS + 1]
    if shape in ("Boxes3D", "Ellipsoids3D"):
        half = np.asarray(facts[f"{shape}:half_sizes"], dtype=float)
        if shape == "Boxes3D":
            signs = np.array([(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)], dtype=float)
            return signs * half + np.asarray(facts.get("Boxes3D:centers", [0.0, 0.0, 0.0]))
        return _sphere() * half
    length, radius = float(facts[f"{shape}:lengths"]), float(facts[f"{shape}:radii"])
    if shape == "Capsules3D":  # from its origin along its z axis, with a half sphere at each end
        low = np.asarray(facts.get("Capsules3D:translations", [0.0, 0.0, 0.0]))
        return np.concatenate([_sphere() * radius + low, _sphere() * radius + low + [0.0, 0.0, length]])
    ring = _ring() * radius
    return np.concatenate([ring + np.array([0.0, 0.0, z]) for z in (-length / 2, length / 2)])


def _ring() -> np.ndarray:
    angles = np.linspace(0, 2 * np.pi, ROUND, endpoint=False)
    return np.stack([np.cos(angles), np.sin(angles), np.zeros(ROUND)], axis=1)


def _sphere() -> np.ndarray:
    tilts = np.linspace(-np.pi / 2, np.pi / 2, 9)
    return np.concatenate([_ring() * np.cos(tilt) + [0.0, 0.0, np.sin(tilt)] for tilt in tilts])


def _is_ground(corners: np.ndarray) -> bool:
    """Return whether a shape is as flat and wide as a floor."""
    size = np.ptp(corners, axis=0)
    return bool(size[2] <= FLAT and min(size[:2]) > 1.0)


def _rgba(shape: str, facts: dict) -> tuple[int, int, int, int]:
    packed = facts.get("Mesh3D:albedo_factor" if shape == "Mesh3D" else f"{shape}:colors", 0x808080FF)
    red, green, blue, alpha = int(packed).to_bytes(4, "big")
    return red, green, blue, alpha


def rotation(quaternion: np.ndarray) -> np.ndarray:
    """Return the rotation matrix (3, 3) of a unit quaternion x, y, z, w."""
    x, y, z, w = (float(v) for v in quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
