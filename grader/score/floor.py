"""A floor from above, cut into cells: what stands on it, what a lidar has hit and passed, and the usual mistakes.

For checks of maps. The truth is computed from the shapes of the world in the recording, from the simulator's poses of
the robot, and from the scans as they were sent.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gz_course.grader.record.reading import Poses, Recording
from gz_course.grader.score.true_pose import heading, true_poses

SCAN = "topics/scan"
TURNED = 1.0  # [rad], enough to tell headings apart
STOOD = 0.3  # [m] a robot that has driven less stands where it began
Array = np.ndarray


@dataclass(frozen=True)
class Shapes:
    """The obstacles from above: names, poses x, y [m] and yaw [rad], and half sizes or radii [m]."""

    boxes: list[tuple[str, tuple[float, float, float], Array]]
    cylinders: list[tuple[str, tuple[float, float, float], float]]

    def distances(self, points: Array) -> tuple[Array, list[str]]:
        """Return the distances [m] from points (n, 2) to each obstacle, shape (obstacles, n), and their names."""
        out, names = [], []
        for name, (x, y, yaw), half in self.boxes:
            d, c, s = points - (x, y), np.cos(yaw), np.sin(yaw)
            local = np.abs(np.stack([d[:, 0] * c + d[:, 1] * s, d[:, 1] * c - d[:, 0] * s], 1)) - half
            out.append(np.linalg.norm(np.maximum(local, 0), axis=1))
            names.append(name)
        for name, (x, y, _), radius in self.cylinders:
            out.append(np.maximum(np.linalg.norm(points - (x, y), axis=1) - radius, 0))
            names.append(name)
        return np.array(out).reshape(len(out), len(points)), names

    def nearest(self, points: Array) -> Array:
        return np.asarray(self.distances(points)[0].min(axis=0, initial=np.inf))


@dataclass(frozen=True)
class Scans:
    """All scans until a time: the true `pose` of each (n, 3), its `ranges` (n, rays) [m], and the `angles` (rays,).

    `hit` says which rays have hit something; `ends` are the ranges, with `farthest` for the others.
    """

    pose: Array
    ranges: Array
    angles: Array
    hit: Array
    farthest: float

    @property
    def ends(self) -> Array:
        return np.where(self.hit, self.ranges, self.farthest)


@dataclass(frozen=True)
class Grid:
    """The cells into which a floor is cut: their size [m], their numbers, and the corner of the first one [m]."""

    resolution: float
    width: int
    height: int
    left: float
    bottom: float

    def cells(self, points: Array) -> Array:
        """Return how many of the points (n, 2) [m] lie in each cell."""
        column = np.floor((points[:, 0] - self.left) / self.resolution).astype(int)
        row = np.floor((points[:, 1] - self.bottom) / self.resolution).astype(int)
        inside = (column >= 0) & (column < self.width) & (row >= 0) & (row < self.height)
        counts = np.bincount(row[inside] * self.width + column[inside], minlength=self.width * self.height)
        return counts.reshape(self.height, self.width)

    def middles(self) -> Array:
        """Return the middles of all cells (cells, 2) [m], row by row."""
        x = self.left + (np.arange(self.width) + 0.5) * self.resolution
        y = self.bottom + (np.arange(self.height) + 0.5) * self.resolution
        columns, rows = np.meshgrid(x, y)
        return np.stack([columns.ravel(), rows.ravel()], 1)

    def along(self, scan: Scans, start: Array | float, end: Array | float, which: Array) -> Array:
        """Return how many points lie in each cell: on the rays `which`, half a cell apart, from `start` to `end`."""
        steps = np.arange(0, scan.farthest + 2, self.resolution / 2)
        number, ray = np.nonzero(which)
        first, last = np.broadcast_to(start, which.shape)[number, ray], np.broadcast_to(end, which.shape)[number, ray]
        index, step = np.nonzero((steps >= first[:, None]) & (steps < last[:, None]))
        direction = scan.pose[number, 2] + scan.angles[ray]
        x = scan.pose[number[index], 0] + steps[step] * np.cos(direction[index])
        y = scan.pose[number[index], 1] + steps[step] * np.sin(direction[index])
        return self.cells(np.stack([x, y], 1))


def shapes(recording: Recording) -> Shapes:
    """Return what stands in the world, without the ground and the robot."""
    boxes, cylinders = [], []
    for entity in recording.entities("world"):
        model, *rest = entity.removeprefix("world/").split("/")
        held = recording.static(entity)
        if len(rest) != 2 or model in ("robot", "path", "ground_plane"):
            continue
        poses = recording.poses(f"world/{model}")
        if poses is None:
            continue
        pose = flat(poses)
        if "Boxes3D:half_sizes" in held:
            boxes.append((model, pose, np.array(held["Boxes3D:half_sizes"][:2])))
        elif "Cylinders3D:radii" in held:
            cylinders.append((model, pose, float(held["Cylinders3D:radii"])))
    return Shapes(boxes, cylinders)


def flat(poses: Poses) -> tuple[float, float, float]:
    """Return x, y [m] and yaw [rad] of the first of some poses."""
    x, y, _ = poses.positions[0]
    return float(x), float(y), heading(poses.quaternions[0])


def scans(recording: Recording, until: float) -> Scans:
    """Return the scans that arrived until a time [s]."""
    arrived, rows = recording.arrays(f"{SCAN}/ranges")
    number = int(np.sum(arrived / 1e9 <= until))
    values = {n: recording.signal(f"{SCAN}/{n}").values for n in ("range_min", "range_max", "angle_min")}
    step, stamps = recording.signal(f"{SCAN}/angle_increment").values, recording.signal(f"{SCAN}/header/stamp").values
    if not number:
        return Scans(np.zeros((0, 3)), np.zeros((0, 1)), np.zeros(1), np.zeros((0, 1), dtype=bool), 0.0)
    ranges = np.stack(rows[:number])
    hit = (ranges > values["range_min"][0]) & (ranges < values["range_max"][0])
    angles = values["angle_min"][0] + step[0] * np.arange(ranges.shape[1])
    return Scans(true_poses(recording, stamps[:number]), ranges, angles, hit, float(values["range_max"][0]))


def hits(scan: Scans, pose: Array | None = None, angles: Array | None = None, which: Array | None = None) -> Array:
    """Return the points (n, 2) [m] of all hits, or of the rays `which`, as if pose or angles had been others."""
    pose = scan.pose if pose is None else pose
    direction = (pose[:, 2:] + scan.angles) if angles is None else angles
    which = scan.hit if which is None else which
    ends = scan.ends
    x, y = pose[:, :1] + ends * np.cos(direction), pose[:, 1:2] + ends * np.sin(direction)
    return np.stack([x[which], y[which]], 1)


def grown(marked: Array) -> Array:
    """Return the cells that are marked, or beside one that is, also across the corner."""
    wide = np.pad(marked, 1)
    parts = [wide[dy : dy + marked.shape[0], dx : dx + marked.shape[1]] for dy in range(3) for dx in range(3)]
    return np.asarray(np.logical_or.reduce(parts))


def from_the_first(pose: Array) -> Array:
    """Return poses (n, 3) as the first of them sees them."""
    c, s = np.cos(pose[0, 2]), np.sin(pose[0, 2])
    x, y = (pose[:, :2] - pose[0, :2]).T
    return np.stack([c * x + s * y, c * y - s * x, pose[:, 2] - pose[0, 2]], 1)


def misplaced(scan: Scans) -> Iterator[tuple[str, Array]]:
    """Yield common mistakes with the pose and with angles, and the points (n, 2) [m] at which they draw the hits."""
    pose, angles, heading = scan.pose, scan.angles, scan.pose[:, 2:]

    def other(x: float = 1.0, turn: float = 1.0) -> Array:
        return pose * (x, x, turn)

    stood = len(pose) > 0 and bool(np.ptp(pose[:, :2], axis=0).max() < STOOD)  # a start subtracted looks the same
    ignored = "ignored, or counted from the robot's start" if stood else "ignored"
    yield "the robot's heading is ignored: walls turn with the robot", hits(scan, other(turn=0))
    yield f"the robot's position is {ignored}: every scan is drawn around (0, 0)", hits(scan, other(x=0))
    yield (
        f"the robot's pose is {ignored}: every scan is drawn around (0, 0), as the robot sees it",
        hits(scan, other(0, 0)),
    )
    if len(pose) and not stood:
        yield (
            "the robot's first position is subtracted: the map is drawn around its start, not around (0, 0)",
            hits(scan, pose - (*pose[0, :2], 0)),
        )
        yield (
            "the robot's first pose is subtracted: the map is drawn as it is seen from its start",
            hits(scan, from_the_first(pose)),
        )
    yield (
        "the lidar is taken for one that is about 0.2 m ahead of the robot's middle: it is above it",
        hits(scan, pose + 0.2 * np.stack([np.cos(pose[:, 2]), np.sin(pose[:, 2]), 0 * pose[:, 2]], 1)),
    )
    yield "the robot's heading is subtracted instead of added", hits(scan, other(turn=-1))
    for words, direction in (
        ("cos and sin take radians, and your angles are in degrees", np.degrees(heading + angles)),
        ("the heading is in degrees, the angles of the rays are in radians", np.degrees(heading) + angles),
        ("the angles of the rays are in degrees, the heading is in radians", heading + np.degrees(angles)),
        ("angles are converted from degrees, but they are in radians already", np.radians(heading + angles)),
        ("the angles of a scan are converted from degrees, but they are in radians", heading + np.radians(angles)),
        ("the heading is converted from degrees, but it is in radians", np.radians(heading) + angles),
        ("the first ray is taken for the one ahead: its angle is angle_min", heading + angles - angles[0]),
        (
            "the number of a ray is taken for its angle in degrees: it is angle_min + number * angle_increment",
            heading + np.radians(np.arange(len(angles))),
        ),
        (
            "the rays are taken to be one degree apart: they are angle_increment apart",
            heading + angles[0] + np.radians(np.arange(len(angles))),
        ),
        ("the rays are drawn in the opposite order: angles grow to the left", heading - angles),
        ("orientation.z is taken for the heading: it is the sine of half of it", np.sin(heading / 2) + angles),
        ("the heading is half of what it is: it is 2 * atan2(orientation.z, orientation.w)", heading / 2 + angles),
        (
            "the heading is made with 1 + 2 * (y * y + z * z), and it is 1 - 2 * (y * y + z * z)",
            np.arctan2(np.sin(heading), 1 + 2 * np.sin(heading / 2) ** 2) + angles,
        ),
        ("the heading is made by asin, which knows no angle beyond a right one", np.arcsin(np.sin(heading)) + angles),
        ("the rays are spread over half a turn: they go from angle_min to angle_max", heading + angles / 2),
        (
            "the rays are spread over half a turn, from 0 on: they go from angle_min to angle_max",
            heading + (angles - angles[0]) / 2,
        ),
        ("the heading is added two times", 2 * heading + angles),
        ("the heading has lost its sign, as by acos: a turn to the right is negative", np.abs(heading) + angles),
        ("orientation.w is taken for the heading: it is the cosine of half of it", np.cos(heading / 2) + angles),
        (
            "angle_max is taken for the angle of the first ray: it is angle_min",
            heading + angles - angles[0] + angles[-1],
        ),
    ):
        yield words, hits(scan, angles=direction)
    if len(pose) and np.ptp(heading) > TURNED:  # any wrong heading looks like another one while it stays the same
        for words, other_heading in (
            ("the two arguments of atan2 are exchanged where the heading is made: the sine comes first", np.pi / 2),
            ("z and w are exchanged in the heading: it is 2 * atan2(orientation.z, orientation.w)", np.pi),
        ):
            yield words, hits(scan, angles=other_heading - heading + angles)
    if len(pose) and not scan.hit.all():
        yield (
            "rays without a hit are left out before the others are numbered: the angle of ray i is angle_min + i * "
            "angle_increment, where i counts all rays",
            hits(scan, angles=heading + angles[np.maximum(np.cumsum(scan.hit, axis=1) - 1, 0)]),
        )
    yield "sine and cosine are exchanged", hits(scan, angles=np.pi / 2 - heading - angles)
