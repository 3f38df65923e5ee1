"""When feedback comes that comes too seldom."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect

if TYPE_CHECKING:
    from .patrol_run import Run

SOON = 0.6  # [s] after the patrol, or a new waypoint, began
THERE = 0.3  # [m] from a waypoint
REGULAR = 0.25  # of a pause between messages
FEW = 4  # messages whose pauses tell a rate


def rare(run: Run, said: list[Any], start: float, end: float) -> str:
    """Return when the feedback `said` of a patrol comes, whose pauses are too long, and the place in the file."""
    indices = [each["waypoint"] for each in said]
    where = suspect(run.recording, "rare_feedback")
    where = f": {where}" if where else ""
    while_driving = "and not while the robot drives"
    if len(said) == 1 and said[0]["at"] < start + SOON:
        return f"Feedback is published once, when the patrol begins, {while_driving}{where}"
    if len(said) > 1 and len(set(indices)) == len(said) <= len(run.waypoints("patrol")):
        if said[0]["at"] < start + SOON:
            return f"Feedback is published once for each waypoint, when it begins, {while_driving}{where}"
        if left(run, said[0]) < THERE:
            return f"Feedback is published once for each waypoint, when it is reached, {while_driving}{where}"
    words = f"Your feedback is too rare: {len(said)} messages in {end - start:.0f} s"
    if len(said) > end - start:
        words = "Your feedback stays away for more than a second at times"
    pauses = np.diff([each["at"] for each in said])
    if FEW <= len(said) <= end - start and np.ptp(pauses) < REGULAR * pauses.mean():
        return f"{words}, one every {pauses.mean():.1f} s{where}"
    return words + where


def left(run: Run, message: dict[str, float | str]) -> float:
    """Return how far the robot was from its nearest waypoint when a message came [m]."""
    here = run.way[np.searchsorted(run.times, message["at"]).clip(0, len(run.times) - 1)]
    return float(np.hypot(*(np.array(run.waypoints("patrol")) - here).T).min())
