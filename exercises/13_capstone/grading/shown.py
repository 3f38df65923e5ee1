"""What a map that has no wall in a wrong place shows wrongly, so that a robot that drives by it is led astray."""

from __future__ import annotations

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.record.reading import Recording

from . import map_faults

OCCUPIED, FREE = 65, 25  # at least, at most
FEWEST = 30  # cells; fewer say nothing about a map
MOST, MANY, FEW = 0.92, 0.5, 0.05  # shares of the cells that rays passed


def wrongly(recording: Recording, said: np.ndarray, passed: np.ndarray, hit: np.ndarray) -> str:
    """Return what is wrong with a map, given the cells that rays `passed`, and those that were `hit`; or nothing."""
    values, walls = said[passed], (said >= OCCUPIED).sum()
    if (values >= OCCUPIED).mean() > MANY:
        return f"{(values >= OCCUPIED).mean():.0%} of the cells that rays passed are occupied in the map: they are free"
    if (values < 0).mean() > MOST and walls >= FEWEST:
        return "hardly any cell is free, only the hits are drawn: the cells between the robot and a hit are free"
    if (values < 0).mean() > FEW and (words := suspect(recording, "threshold")):
        return words
    if (values < 0).mean() > MANY and (said < 0).mean() > 0.999:
        return suspect(recording, "forgets", "cell") or "all cells of the map are unknown"
    if (values < 0).mean() > MANY and walls >= FEWEST:
        return map_faults.not_free(said, passed, np.zeros_like(passed))
    between = (values > FREE) & (values < OCCUPIED)
    if between.mean() > MANY:
        return f"most cells that rays passed have values such as {np.median(values[between]):.0f}, which is not free"
    shown = said[hit]
    if walls < FEWEST <= hit.sum() and ((shown >= 0) & (shown <= FREE)).mean() > MANY:
        return suspect(recording, "erased") or map_faults.hardly_any(recording, said, [], hit)
    return ""
