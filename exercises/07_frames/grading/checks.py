"""Are the points on /nearest_hit where the nearest hit of their scan was, in the frame odom?

The truth is computed from the scan as it was sent, from the simulator's pose of the robot at that time, and from the
mount of the scanner in the simulated robot. Wrong points are compared with those of common misconceptions, some of
which are in `misconceptions.py`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.grader.score.true_pose import true_poses

from . import headers, misconceptions, other_hits, unanswered
from .geometry import Frame, about_z, matrices, mounted, polar

TOLERANCE = 0.05  # [m]
CLOSE = 0.03  # [m] of the points of a misconception
SHARE = 0.9  # of the scans that must be right
FEWEST = 4  # points; fewer may fit a misconception by chance
TURNS = 0.5  # [rad/s] faster is turning
STEADY = 0.2  # [rad/s] change of the turning rate within `AROUND`; more is a change of speed, which is not judged
AROUND = 0.1  # [s]
SAME = 5e-4  # [s] between equal stamps
TOPIC, SCAN, TF = "topics/nearest_hit", "topics/scan", "topics/tf"
PUBLIC_MOUNT = (0.2, -0.14, 0.3), (0.0, 0.0, np.sin(1.0), np.cos(1.0))  # of turned_lidar.sdf: place [m], quaternion


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


def chosen(recording: Recording, found: Scans, turning: bool) -> np.ndarray:
    """Return the numbers of the scans at which the robot turns, or does not, at a steady rate."""
    rate = recording.signal("truth/robot/angular_z")
    at = rate.times / 1e9
    around = [np.interp(found.stamps + shift, at, rate.values) for shift in (-AROUND, 0.0, AROUND)]
    steady = np.ptp(around, axis=0) < STEADY
    return np.flatnonzero(steady & ((np.abs(around[1]) > TURNS) == turning))


def places(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if nearly all points are where their hit was, at the scans in which the robot turns or does not."""
    expected = f"the nearest hit of each scan in odom, within {TOLERANCE * 100:.0f} cm"
    found = scans(recording)
    which = np.zeros(0, dtype=int) if found is None else chosen(recording, found, parameters["turning"])
    if found is None or not len(which):
        return Finding(False, expected, "no scan was sent")
    truth = right(recording, found)
    met = near(found.points, truth, TOLERANCE)[which]
    missing = np.isnan(found.points[which, 0])
    measured = f"{met.sum()} of {len(which)} scans right"
    bad = np.flatnonzero(~met & ~missing)
    if missing.any():
        measured += f", {missing.sum()} without a point"
    if infinite := sum(len(recording.signal(f"{TOPIC}/point/{axis}/not_finite")) for axis in "xyz"):
        measured += f", {infinite} coordinates were inf, -inf or nan"
    if len(bad):
        n = which[bad[0]]
        measured += (
            f"; at {found.stamps[n]:.2f} s it said {shown(found.points[n])}, the truth was {shown(truth[n])}: "
            f"{np.linalg.norm(found.points[n] - truth[n]):.2f} m away"
        )
    if met.mean() >= SHARE:
        return Finding(True, expected, measured)
    first = which[np.flatnonzero(~met)[0]]
    why = (
        several(recording, found)
        or otherwise_assigned(recording, found, truth, which, missing)
        or explanation(recording, found, truth, which, bad)
        or unanswered.reason(recording, infinite, int((~missing).sum()), len(which))
        or unanswered.left_out(found, near(found.points, truth, TOLERANCE), truth)
    )
    if "nothing was transformed" in why:
        why += unanswered.shared_header(recording)
    return Finding(False, expected, measured, round(float(found.arrived[first]), 3), explanation=why)


def several(recording: Recording, found: Scans) -> str:
    stamps = recording.signal(f"{TOPIC}/header/stamp")
    return other_hits.several(found.number, stamps.times, stamps.values)


def otherwise_assigned(
    recording: Recording, found: Scans, truth: np.ndarray, which: np.ndarray, missing: np.ndarray
) -> str:
    """Explain points whose stamps are not those of the scans: they are taken for the scans before which they came."""
    if missing.mean() < 0.5:
        return ""
    for each in assigned(recording, found, truth)[1:]:
        there = ~np.isnan(each.points[which, 0])
        bad = np.flatnonzero(there & ~near(each.points, truth, TOLERANCE)[which])
        why = explanation(recording, each, truth, which, bad, guess=False)
        if there.mean() >= 0.5 and why:
            return why
    return ""


def shown(point: np.ndarray) -> str:
    return "(" + ", ".join(f"{v:.2f}" for v in point) + ")"


def explanation(
    recording: Recording, found: Scans, truth: np.ndarray, which: np.ndarray, bad: np.ndarray, guess: bool = True
) -> str:
    """Return which misconceptions fit nearly all points that are wrong; empty if none does."""
    if len(bad) < FEWEST:
        return ""
    wrong = which[bad]
    fitting: list[Any] = []
    same: list[Any] = []
    with np.errstate(all="ignore"):
        for words, predicted in predictions(recording, found, truth):
            known = ~np.isnan(predicted[wrong, 0])
            if known.sum() < FEWEST or near(found.points, predicted, CLOSE)[wrong][known].mean() < SHARE:
                continue
            if words not in fitting and not any(near(predicted, other, CLOSE / 3)[wrong].all() for other in same):
                fitting.append(words)
                same.append(predicted)
    off = [np.nanmedian(np.linalg.norm(found.points - each, axis=-1)[wrong]) for each in same]
    fitting = [fitting[i] for i in np.argsort(np.round(off, 2), kind="stable")]
    if not fitting and not guess:
        return ""
    if not fitting:
        seen = both_frames(recording, found).inverse().of(found.points)
        first, step = map(float, found.angles[0])
        apart = misconceptions.apart(
            found.points[wrong], truth[wrong], seen[wrong], found.hits[wrong], step, found.rays[wrong], first
        )
        hit = other_hits.some_hit(found, wrong, seen)
        fitting = [hit if not apart.startswith("all") and hit else apart]
    return f"your points are {', or '.join(fitting[:2])}" if fitting[0] else ""


def both_frames(recording: Recording, found: Scans) -> Frame:
    """Return the poses of the scanner in odom, one for each scan."""
    robot = odom(recording, found.stamps)
    return Frame(np.einsum("nij,njk->nik", robot.turn, found.mount.turn), robot.of(found.mount.place))


def predictions(recording: Recording, found: Scans, truth: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the end of the sentence "your points are ..." and what a program with that misconception publishes."""
    robot, mount, hits = odom(recording, found.stamps), found.mount, found.hits
    both = both_frames(recording, found)
    on_robot, count = mount.of(hits), len(hits)
    heard = recording.signal(f"{TF}/count").times / 1e9

    def at(times: np.ndarray) -> np.ndarray:
        return odom(recording, times).of(on_robot)

    def latest(times: np.ndarray) -> np.ndarray:
        index = np.searchsorted(heard, times) - 1
        return at(np.where(index >= 0, heard[np.maximum(index, 0)], np.nan))

    still = Frame(np.repeat(np.eye(3)[None], count, 0), np.zeros((count, 3)))
    written = mounted(*PUBLIC_MOUNT, count)
    flat = truth * (1, 1, 0)
    before = robot.of(np.concatenate([np.full((1, 3), np.nan), on_robot[:-1]]))
    newest = np.searchsorted(found.arrived, found.answered + SAME) - 1  # scan, when the point was published
    newer = np.where((newest > np.arange(count))[:, None], robot.of(on_robot[np.maximum(newest, 0)]), np.nan)
    yield "in the scanner's own frame: nothing was transformed", hits
    yield "in the frame of the robot: the transform from the robot to odom is missing", on_robot
    yield "those of a scanner in the robot's middle, looking ahead: the scanner's mount is missing", robot.of(hits)
    yield "not turned as the scanner is: the rotation of its mount is missing", robot.of(hits + mount.place)
    yield "not shifted as the scanner is: the translation of its mount is missing", robot.of(mount.turned(hits))
    yield "shifted by the robot's place, but not turned by its heading", on_robot + robot.place
    yield "shifted, but not turned: the rotations of scanner and robot are missing", hits + mount.place + robot.place
    yield "shifted by the whole transform, but not turned: its rotation is missing", hits + both.place
    yield "turned by the whole transform, but not shifted: its translation is missing", both.turned(hits)
    yield "turned by the robot's heading, but not shifted by its place", robot.turned(on_robot)
    yield "first shifted and then turned: a transform rotates first, then it shifts", both.turned(hits + both.place)
    back = both.inverse()
    yield "turned the wrong way: the rotation is that of the opposite transform", back.turned(hits) + both.place
    yield "those of the opposite transform: lookup_transform takes the target, odom, first", back.of(hits)
    yield "those of the scanner's mount applied in the opposite direction", robot.of(mount.inverse().of(hits))
    yield "those of the transform from odom to the robot: the opposite direction", robot.inverse().of(on_robot)
    yield "those of the latest transform when the scan came, not of that at the scan's stamp", latest(found.arrived)
    yield (
        "those of the latest transform when they were published, not of that at the scan's stamp",
        latest(found.answered),
    )
    whole = np.floor(found.stamps)
    yield "those of the transform at the whole second: stamp.sec without stamp.nanosec is not the time", at(whole)
    yield (
        "those of the transform in the first second: stamp.nanosec without stamp.sec is not the time",
        at(found.stamps - whole),
    )
    yield "those of the transform one scan earlier", at(found.stamps - 0.1)
    yield "those of the transform one scan later", at(found.stamps + 0.1)
    yield "those of a transform that was looked up once, at the beginning", at(np.full(count, found.stamps[0]))
    for shift in (0.05, *np.arange(0.15, 1.01, 0.05), *np.arange(-1.0, -0.14, 0.05), -0.05):
        side = "before" if shift > 0 else "after"
        yield f"those of the transform {abs(shift):.2f} s {side} the scan's stamp", at(found.stamps - shift)
    yield "the hit of the scan before, moved by the transform of this scan", before
    yield "the hits of the scan that has just come, moved by the transform of one that waited: use the one scan", newer
    yield "right on the floor plan, but z is 0: a point in odom is as high as the scanner", flat
    upright = robot.of(mount.flat().of(hits))
    yield "those of an upright scanner: its rotation is more than a heading, use the quaternion", upright
    yield "those of an upright scanner: its rotation is more than a heading; and z is 0", upright * (1, 1, 0)
    yield "those of the mount in the public world: ask /tf_static, other robots differ", robot.of(written.of(hits))
    yield (
        "those of both transforms in the wrong order: the mount leads to the robot, then comes its pose",
        mount.of(robot.of(hits)),
    )
    yield "the place of the robot, not of the hit", robot.place
    yield "the place of the scanner, not of the hit", both.place
    yield (
        "turned by the robot's heading only: the rotation of the scanner's mount is missing",
        robot.turned(hits) + both.place,
    )
    yield "turned by the rotation of the mount only: that of the robot is missing", mount.turned(hits) + both.place
    unturned = both.turned(hits) + mount.place + robot.place
    yield "those of a mount that does not turn with the robot: its translation belongs to the robot's axes", unturned
    yield "the way from the robot to the hit: the robot's place is missing", truth - robot.place
    yield "mirrored: their y has the wrong sign", truth * (1, -1, 1)
    yield "mirrored: their x has the wrong sign", truth * (-1, 1, 1)
    yield "mirrored: x and y have the wrong sign", truth * (-1, -1, 1)
    yield "those with x and y exchanged", truth[:, [1, 0, 2]]
    for in_odom, words, points in other_hits.rounded(truth, hits):
        yield words, points if in_odom else both.of(points)
    for words, points in other_hits.of_other_measures(found, both, mount):
        yield words, both.of(points)
    yield "moved by the opposite of the translation: it is added, not subtracted", both.turned(hits) - both.place
    yield "moved by the robot's place twice: the transform to odom holds it already", truth + robot.place
    yield "transformed twice by the mount of the scanner", robot.of(mount.of(on_robot))
    yield "transformed twice", both.of(both.of(hits))
    yield "transformed twice by the pose of the robot", robot.of(robot.of(on_robot))
    for words, (x, y, z, w) in misconceptions.of_other_quaternions(both.turn):
        yield words, Frame(matrices(x, y, z, w), both.place).of(hits)
    for words, points in misconceptions.of_other_headings(both.turn, hits, found.points - both.place):
        yield words, points + both.place
    for other_points in (misconceptions.of_other_matrices, misconceptions.of_other_formulas):
        for words, points in other_points(both.turn, hits):
            yield words, points + both.place
    for words, points in misconceptions.of_other_rays(found):
        yield words, both.of(points)
    yield "always the same", still.place + found.points[~np.isnan(found.points[:, 0])][:1]


def stamps(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if nearly all scans got one point with their own stamp, and no point has another stamp."""
    expected = "one point with the stamp of each scan"
    sent = values(recording, f"{SCAN}/header/stamp")[1:]
    given = recording.signal(f"{TOPIC}/header/stamp")
    if not len(given):
        return Finding(False, expected, "no point was published")
    if not len(sent):
        return Finding(False, expected, "no scan was sent")
    found = scans(recording)
    off = np.min(np.abs(given.values[:, None] - np.append(sent, 0.001)[None, :]), axis=1)
    other = off > SAME if found is None or found.by_stamp else np.full(len(off), True)
    covered = np.min(np.abs(sent[:, None] - given.values[None, :]), axis=1) <= SAME
    covered &= not other.all()
    measured = f"{covered.sum()} of {len(sent)} scans have a point with their stamp"
    if other.mean() <= 1 - SHARE and (many := "" if found is None else several(recording, found)):
        return Finding(False, expected, f"{measured}; {len(given)} points were published", explanation=many)
    if other.mean() <= 1 - SHARE and covered.mean() >= SHARE:
        return Finding(True, expected, measured)
    if other.mean() <= 1 - SHARE:
        return Finding(False, expected, measured)
    example = np.flatnonzero(other)[0]
    heard = recording.signal(f"{TF}/count").times / 1e9
    at = float(given.times[example] / 1e9)
    measured += f"; at {at:.2f} s a point had the stamp {given.values[example]:.3f} s"
    return Finding(False, expected, measured, round(at, 3), explanation=headers.stamps(given, other, sent, heard))


def frames(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if every point names the frame odom."""
    expected = "frame_id 'odom'"
    named = [line.text for line in recording.lines(f"{TOPIC}/header/frame_id")]
    if not recording.has(f"{TOPIC}/count"):
        return Finding(False, expected, "no point was published")
    wrong = [name for name in dict.fromkeys(named) if name != "odom"]
    if not wrong and named:
        return Finding(True, expected, "frame_id 'odom'")
    said = wrong[0] if wrong else ""
    return Finding(False, expected, f"frame_id {said!r}", explanation=headers.frame(said))
