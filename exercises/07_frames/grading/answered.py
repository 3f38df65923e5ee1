"""The scans with a hit that were sent, and the points that were published for each of them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gz_course.grader.record.reading import Recording
from gz_course.grader.score.true_pose import true_poses

from . import other_hits
from .geometry import Frame, about_z, mounted, polar

TOLERANCE = 0.05  # [m]
SHARE = 0.9  # of the scans that must be right
SAME = 5e-4  # [s] between equal stamps
TOPIC, SCAN, TF = "topics/nearest_hit", "topics/scan", "topics/tf"


@dataclass(frozen=True)
class Scans:
    """All scans with a hit, and the points that were published for them, one a row.

    `arrived` are their times of arrival [s], `stamps` those of their measurement [s]; `rows` the ranges [m], `angles`
    those of the first ray and between two [rad]; `hits` the nearest hits in the scanner's frame (n, 3) [m], `rays`
    their numbers. `points` (n, 3) [m] is NaN where there is none, `answered` when it came [s], `number` how many there
    were; `by_stamp`: the points belong to the scans whose stamps they have.
    """

    arrived: np.ndarray
    stamps: np.ndarray
    rows: list
    limits: np.ndarray
    angles: np.ndarray
    hits: np.ndarray
    rays: np.ndarray
    mount: Frame
    points: np.ndarray
    answered: np.ndarray
    number: np.ndarray
    by_stamp: bool = True


def values(recording: Recording, name: str) -> np.ndarray:
    return recording.signal(name).values


def odom(recording: Recording, times: np.ndarray) -> Frame:
    """Return the robot's true poses at times [s]; the frame odom is that of the world."""
    poses = true_poses(recording, times, ("x", "y", "z", "yaw"))
    return Frame(about_z(poses[:, 3]), poses[:, :3])


def scans(recording: Recording) -> Scans | None:
    """Return all scans of a recording; None if there are none."""
    arrived, rows = recording.arrays(f"{SCAN}/ranges")
    low, high, first, step, stamps = (
        values(recording, f"{SCAN}/{name}")
        for name in ("range_min", "range_max", "angle_min", "angle_increment", "header/stamp")
    )
    known = recording.signal("truth/robot/x").times / 1e9
    kept, hits, rays = [], [], []
    for i, row in enumerate(rows):
        valid = np.where((row > low[i]) & (row < high[i]), row, np.inf)
        ray = int(np.argmin(valid))
        # The transforms begin after the first scan.
        if np.isfinite(valid[ray]) and len(known) and stamps[i] > 0.05:
            kept.append(i)
            rays.append(ray)
            hits.append((valid[ray], first[i] + ray * step[i]))
    if not kept:
        return None
    places = np.array(hits)
    poses = recording.poses("world/robot/scanner")
    assert poses is not None
    count = len(kept)
    found = Scans(
        arrived=arrived[kept] / 1e9,
        stamps=stamps[kept],
        rows=[rows[i] for i in kept],
        limits=np.stack([low[kept], high[kept]], -1),
        angles=np.stack([first[kept], step[kept]], -1),
        hits=polar(places[:, 0], places[:, 1]),
        rays=np.array(rays),
        mount=mounted(poses.positions[-1], poses.quaternions[-1], count),
        points=np.full((count, 3), np.nan),
        answered=np.full(count, np.nan),
        number=np.zeros(count, dtype=int),
    )
    return with_points(recording, found)


def with_points(recording: Recording, found: Scans) -> Scans:
    """Give each scan the point with its stamp, or the one that came after it if only then nearly all are right.

    Who keeps a scan until its transform is there answers when the next one comes. Of several points for one scan, that
    which is farthest from the truth counts.
    """
    truth = right(recording, found)
    best, *others = assigned(recording, found, truth)
    for each in others:
        met, before = (int(np.sum(near(one.points, truth, TOLERANCE))) for one in (each, best))
        if met > before and met >= SHARE * len(recording.signal(f"{TOPIC}/point/x")):
            best = each
    return best


def assigned(recording: Recording, found: Scans, truth: np.ndarray) -> list[Scans]:
    """Return the scans with the points that have their stamps, that came after them, and after the next one."""
    times = recording.signal(f"{TOPIC}/point/x").times / 1e9
    stamps = values(recording, f"{TOPIC}/header/stamp")
    points = np.stack([values(recording, f"{TOPIC}/point/{axis}") for axis in "xyz"], -1)
    last = np.searchsorted(found.arrived, times + SAME) - 1
    with_stamp = np.array([int(np.argmin(np.abs(found.stamps - stamp))) for stamp in stamps], dtype=int)
    strange = np.abs(found.stamps[with_stamp] - stamps) > SAME
    results = []
    for by_stamp, which in ((True, np.where(strange, last, with_stamp)), (False, last), (False, last - 1)):
        given, answered, number = found.points.copy(), found.answered.copy(), found.number.copy()
        for time, scan, point in zip(times, which, points, strict=True):
            if scan < 0:
                continue
            number[scan] += 1
            worse = np.linalg.norm(point - truth[scan]) > np.linalg.norm(given[scan] - truth[scan])
            if np.isnan(given[scan, 0]) or worse:
                given[scan], answered[scan] = point, time
        results.append(replace(found, points=given, answered=answered, number=number, by_stamp=by_stamp))
    return results


def near(points: np.ndarray, others: np.ndarray, within: float) -> np.ndarray:
    with np.errstate(invalid="ignore"):
        return np.linalg.norm(points - others, axis=-1) <= within


def right(recording: Recording, found: Scans) -> np.ndarray:
    """Return the true points (n, 3) [m] in odom."""
    return odom(recording, found.stamps).of(found.mount.of(found.hits))


def several(recording: Recording, found: Scans) -> str:
    stamps = recording.signal(f"{TOPIC}/header/stamp")
    return other_hits.several(found.number, stamps.times, stamps.values)


def both_frames(recording: Recording, found: Scans) -> Frame:
    """Return the poses of the scanner in odom, one for each scan."""
    robot = odom(recording, found.stamps)
    return Frame(np.einsum("nij,njk->nik", robot.turn, found.mount.turn), robot.of(found.mount.place))
