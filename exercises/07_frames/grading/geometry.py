"""Points, and frames in other frames, one a row."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class Frame:
    """Poses of one frame in another, one a row: matrices (n, 3, 3) and places (n, 3) [m]."""

    turn: np.ndarray
    place: np.ndarray

    def of(self, points: np.ndarray) -> np.ndarray:
        """Return points (n, 3) [m] in the outer frame."""
        return self.turned(points) + self.place

    def turned(self, points: np.ndarray) -> np.ndarray:
        return np.einsum("nij,nj->ni", self.turn, points)

    def inverse(self) -> Frame:
        turn = np.transpose(self.turn, (0, 2, 1))
        return Frame(turn, -Frame(turn, self.place).turned(self.place))

    def flat(self) -> Frame:
        """Return the poses with their heading only, as if nothing were tilted or upside down."""
        return replace(self, turn=about_z(np.arctan2(self.turn[:, 1, 0], self.turn[:, 0, 0])))


def about_z(angle: np.ndarray) -> np.ndarray:
    c, s, zero = np.cos(angle), np.sin(angle), np.zeros_like(angle)
    return np.stack([np.stack([c, -s, zero], -1), np.stack([s, c, zero], -1), np.stack([zero, zero, zero + 1], -1)], -2)


def polar(distance: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Return points (n, 3) [m] in the plane of the scanner."""
    return np.stack([distance * np.cos(angle), distance * np.sin(angle), np.zeros_like(angle)], -1)


def matrices(x: np.ndarray, y: np.ndarray, z: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Return the rotation matrices (n, 3, 3) of quaternions."""
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, -1) for row in rows], -2)


def mounted(
    place: np.ndarray | tuple[float, float, float],
    quaternion: np.ndarray | tuple[float, float, float, float],
    count: int,
) -> Frame:
    turn = matrices(*(np.array([float(v)]) for v in quaternion))
    return Frame(np.repeat(turn, count, 0), np.repeat(np.array([place], dtype=float), count, 0))
