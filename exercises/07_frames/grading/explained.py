"""Which misconceptions fit the points that are wrong: what a program with each of them publishes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from gz_course.grader.record.reading import Recording

from . import misconceptions, other_hits
from .answered import (
    SAME,
    SHARE,
    TF,
    TOLERANCE,
    Scans,
    assigned,
    both_frames,
    near,
    odom,
)
from .geometry import Frame, matrices, mounted

CLOSE = 0.03  # [m] of the points of a misconception
FEWEST = 4  # points; fewer may fit a misconception by chance
PUBLIC_MOUNT = (0.2, -0.14, 0.3), (0.0, 0.0, np.sin(1.0), np.cos(1.0))  # of turned_lidar.sdf: place [m], quaternion


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
