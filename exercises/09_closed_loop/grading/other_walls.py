"""What a run looks like whose node keeps from something else than from the wall on its side."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect

from . import steering
from .answered_scans import KEPT, SETTLED, scans

if TYPE_CHECKING:
    from .wall import Run

FIRST = 15  # scans in which the robot was too near


def mean_of_the_side(run: Run) -> str:
    """Find out whether a mean of ranges is taken for the distance: it is larger, so the robot comes too near."""
    late = run.times > SETTLED
    if not late.any() or np.median(run.error[late]) > -0.1:
        return ""
    return suspect(run.recording, "mean")


def other_side(run: Run) -> str:
    late = run.times > SETTLED
    own = np.mean(np.abs(run.error[late]) < KEPT)
    other = np.mean(np.abs(run.other_side - run.wanted)[late] < KEPT)
    if own > 0.15 or other < 0.3:
        return ""
    wrong = "right" if run.side == "left" else "left"
    return f'side is "{run.side}", but the robot keeps its distance from the wall on its {wrong}'


def gaps(run: Run) -> str:
    """Find out whether the robot is too near to its wall where rays beside it hit nothing, and there alone."""
    times, bearings, ranges = scans(run)
    if not len(times):
        return ""
    beside = np.any(np.isposinf(ranges[:, np.abs(bearings - np.pi / 2) < 0.4]), axis=1)
    near = np.flatnonzero((times > 3.0) & (np.interp(times, run.times, run.error) < -0.1))[:FIRST]
    if len(near) < FIRST or beside[near].mean() < 0.8 or beside[times > 3.0].mean() > 0.6:
        return ""
    return (
        f"the robot comes too near where its wall has gaps, first at {times[near[0]]:.1f} s: rays through "
        "them read inf, and inf in a mean is inf; use isfinite on each range"
    )


def nearest_anywhere(run: Run) -> str:
    """Find out whether the robot has left its wall when something on its other side was nearer."""
    times, bearings, ranges = scans(run)
    lost = run.times[(run.times > 3.0) & (run.error > 0.2)]
    if not len(times) or not len(lost):
        return ""
    on_side = np.where((bearings > -0.2) & (ranges > 0), ranges, np.inf).min(axis=1)
    on_other = np.where((bearings < -0.4) & (ranges > 0), ranges, np.inf).min(axis=1)
    nearer = np.flatnonzero((times > lost[0] - 3.0) & (times < lost[0]) & (on_other < on_side))
    if not len(nearer):
        return ""
    first = nearer[0]
    after = (run.times > times[first]) & (run.times < lost[0])
    share = steering.follows(run, times, bearings, ranges)
    if (run.sign * run.turning[after]).mean() > -0.5 or (share and share["all around"] < share["right"] - 0.02):
        return ""
    other = "left" if run.side == "right" else "right"
    return (
        f"at {times[first]:.1f} s something on the {other} of the robot was nearer than its wall, "
        f"{on_other[first]:.2f} m, and it left its wall; take the nearest range on the {run.side}, not of all"
    )
