"""What a run looks like whose node takes no notice of the distance that was set while it ran."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect

from . import law, steering
from .answered_scans import KEPT, SETTLED, point_and_rates, scans

if TYPE_CHECKING:
    from .wall import Run


def old_distance(run: Run) -> str:
    late = run.times > run.changed + 6.0
    if not late.any() or abs(run.asked[-1] - run.asked[0]) < 0.2 or np.abs(run.along[late]).sum() < 1.0:
        return ""
    usual = float(np.median(run.distance[late]))
    before = (run.times > SETTLED) & (run.times < run.changed)
    kept = float(np.median(run.distance[before])) if before.any() else run.asked[0]
    if abs(usual - run.asked[0]) > KEPT or abs(usual - kept) > 0.5 * abs(run.asked[-1] - run.asked[0]):
        return ""
    why = suspect(run.recording, "parameter distance", "parameter")
    if not why and len(scans(run)[0]):
        point, rates, asked = point_and_rates(run)
        new = asked == run.asked[-1]
        if not law.answers_old(point[new], rates[new], run.asked[0], run.asked[-1]):
            return ""
    why = why or "its new value does not reach what it steers by"
    return (
        f"the robot still keeps {usual:.2f} m, although distance was set from {run.asked[0]:g} to {run.asked[-1]:g} m "
        f"at {run.changed:g} s: {why}"
    )


def seldom(run: Run) -> str:
    """Find out whether the new distance is read too late, by the file, and was not answered at first."""
    if not len(scans(run)[0]) or not np.isfinite(run.changed) or not (why := suspect(run.recording, "seldom distance")):
        return ""
    heard, rates, _ = steering.answered(run, scans(run)[0])
    times = scans(run)[0][heard]
    first = (times > run.changed + 0.2) & (times < run.changed + 1.0)
    if not first.any() or abs(rates[first].mean()) > 0.5:
        return ""
    return f"{why}; distance was set from {run.asked[0]:g} to {run.asked[-1]:g} m at {run.changed:g} s"
