"""Why scans got no point: what the node asked tf2 for, as its file says, and what the others have in common."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gz_course.grader.record.reading import Recording

if TYPE_CHECKING:
    from .checks import Scans

FRAMES = ("odom", "robot", "robot/scanner", "robot/base_link", "robot/lidar_link")  # of the bridge
FEW = 0.5  # of the scans
ALIKE = 0.95  # of the scans without a point, that have in common what those with one have not
SOME = 3  # scans with a point, or without one; fewer say nothing


def shared_header(recording: Recording) -> str:
    """Return the end of a sentence on a frame_id that was changed for two messages; empty if none was."""
    for place in recording.facts().get("shared_headers", []):
        return (
            f"; line {place['line']} changes the frame_id of the other message, too: a = b copies no header, so both "
            "have the same one"
        )
    return ""


def reason(recording: Recording, infinite: int, given: int, scans: int) -> str:
    """Return the beginning of a sentence on why `given` of so many scans got a point; empty if it is not known.

    `infinite` coordinates were no finite numbers.
    """
    if given > FEW * scans:
        return ""
    if infinite:
        return (
            f"{infinite} coordinates of your points are inf or nan: a ray without a hit was taken, whose range is inf. "
            "Only ranges between range_min and range_max are hits"
        )
    lookups = recording.facts().get("lookups", [])
    for lookup in lookups:
        if altered := lookup.get("altered"):
            return (
                f"line {lookup['line']} asks for {altered}, which is not the whole name of the scanner's frame: it is "
                "the frame_id of the scan as it stands, with its slash"
            )
        place = f"line {lookup['line']} asks for"
        for frame in lookup["frames"]:
            if frame.startswith("/"):
                return f"{place} the frame {frame!r}: frame names do not begin with a slash in tf2"
            if frame not in FRAMES:
                return (
                    f"{place} the frame {frame!r}, which does not exist here: the transforms lead from odom to robot "
                    "and from there to the frame_id of the scan, as /tf and /tf_static say"
                )
    for lookup in lookups:
        if lookup["gives_up"]:
            return (
                f"line {lookup['line']} asks for the transform of the scan's time when the scan comes; the transform "
                "comes later, and the node drops the scan. Keep the scan, and ask again when the next one comes"
            )
    return ""


def left_out(found: Scans, met: np.ndarray, truth: np.ndarray) -> str:
    """Return what is odd about the scans that got no point, if the others, `met`, are right; `truth` is (n, 3) [m]."""
    there = ~np.isnan(found.points[:, 0])
    if not there.any() or not met[there].all():
        return ""
    last = found.stamps[there][-1]
    if last < 0.6 * found.stamps[-1]:
        return f"the points stop: the last one is that of the scan at {last:.1f} s"
    share = f"only {there.sum()} of {len(there)} scans got a point"
    if words := _in_common(found, there) or _unmoved(there, truth):
        return f"{share}, {words}"
    steps = np.diff(found.stamps[there])
    if len(steps) > 3 and np.ptp(steps) < 0.02 and steps[0] > 0.15:
        return f"{share}, one in {steps[0]:.1f} s, as from a timer: every scan needs one"
    return f"{share}: keep a scan until its transform is there"


def _unmoved(there: np.ndarray, truth: np.ndarray) -> str:
    """Return that scans got no point if their hit was where the last point is; empty if that is not so."""
    before = np.maximum.accumulate(np.where(there, np.arange(len(there)), -1))
    last = np.concatenate([[-1], before[:-1]])
    known = last >= 0
    if min((known & there).sum(), (known & ~there).sum()) < 2 * SOME:
        return ""
    off = np.abs(truth - truth[np.maximum(last, 0)])
    for moved in (np.linalg.norm(off, axis=1), off[:, 0], off[:, 1]):
        limit = np.quantile(moved[known & there], 1 - ALIKE)
        if limit > 0 and np.mean(moved[known & ~there] <= limit) >= ALIKE:
            return f"those whose hit had moved by about {limit:.2f} m since the last point: every scan needs one"
    return ""


def _in_common(found: Scans, there: np.ndarray) -> str:
    """Return by which limit of distance or direction some scans got no point; empty if there is none."""
    if min(there.sum(), (~there).sum()) < SOME:
        return ""
    distance = np.linalg.norm(found.hits, axis=1)
    angle = np.degrees(np.arctan2(found.hits[:, 1], found.hits[:, 0]))
    far, near = distance[there].max(), distance[there].min()
    if np.mean(distance[~there] > far) >= ALIKE:
        return f"those whose nearest hit is nearer than about {far:.1f} m: a hit counts up to range_max"
    if np.mean(distance[~there] < near) >= ALIKE:
        return f"those whose nearest hit is farther than about {near:.1f} m: a hit counts from range_min on"
    low, high = angle[there].min(), angle[there].max()
    if np.mean((angle[~there] < low) | (angle[~there] > high)) >= ALIKE and (~there).sum() > 2 * SOME:
        return f"those whose nearest hit is between {low:.0f} and {high:.0f} degrees: all rays of the scan count"
    return ""
