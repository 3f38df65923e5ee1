"""Are the points on /nearest_hit where the nearest hit of their scan was, in the frame odom?

The truth is computed from the scan as it was sent, from the simulator's pose of the robot at that time, and from the
mount of the scanner in the simulated robot. Wrong points are compared with those of common misconceptions, some of
which are in `misconceptions.py`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding

from . import headers, unanswered
from .answered import (
    SAME,
    SCAN,
    SHARE,
    TF,
    TOLERANCE,
    TOPIC,
    Scans,
    near,
    right,
    scans,
    several,
    values,
)
from .explained import explanation, otherwise_assigned

TURNS = 0.5  # [rad/s] faster is turning
STEADY = 0.2  # [rad/s] change of the turning rate within `AROUND`; more is a change of speed, which is not judged
AROUND = 0.1  # [s]


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


def shown(point: np.ndarray) -> str:
    return "(" + ", ".join(f"{v:.2f}" for v in point) + ")"


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
