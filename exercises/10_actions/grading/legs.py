"""When a server leaves a waypoint too early, by the time that has gone, and where it goes after the last one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .patrol_run import Run

MISSED = 0.17  # [m] from a waypoint that was left
SAME = 0.12  # [s] by which equal times may differ
GOALS = ("patrol", "cancelled", "again")


def left_by_time(run: Run) -> str:
    """Return that waypoints are left after a time, wherever the robot is; empty if no time fits, or too few are left.

    Two legs at least, of unequal lengths, must have been left so.
    """
    legs = [each for goal in GOALS if run.one("accepted", goal) for each in _missed(run, goal)]
    lengths, times, speeds, left = np.array(legs).reshape(-1, 4).T
    if len(legs) < 2 or np.ptp(lengths) < 0.1:
        return ""
    farthest = f"{left.max():.2f} m away"
    if np.ptp(times) < SAME:
        return (
            f"Your server goes on to the next waypoint {np.median(times):.1f} s after it has set out for one, wherever "
            f"the robot is then ({farthest}): a waypoint is over when the robot is there, not after a time or a number "
            "of iterations"
        )
    if np.all(np.abs(times - lengths / speeds) < SAME + 0.05 * times):
        return (
            "Your server goes on to the next waypoint after the time that the way takes at the speed of the goal, "
            f"wherever the robot is then ({farthest}): the robot needs longer, because it turns first; ask /odom where "
            "it is"
        )
    return ""


def goes_on(run: Run) -> str:
    """Return where the robot drives after the last waypoint of the patrol, if it goes on to the first, or back."""
    points, (start, end) = np.array(run.waypoints("patrol"), dtype=float), run.period("patrol")
    chosen = (run.times >= start) & (run.times <= end)
    way = run.way[chosen]
    for place in points:
        at = np.flatnonzero(np.hypot(*(way - place).T) < MISSED)
        if not len(at):
            return ""
        way = way[at[0] :]
    places = [("to the first waypoint again", points[0]), ("back to where the patrol began", run.way[chosen][0])]
    for words, place in places:
        if np.hypot(*(place - points[-1])) > 2 * MISSED and np.hypot(*(way - place).T).min() < MISSED:
            return f"After the last waypoint, the robot drives on {words}; the patrol is over at the last waypoint"
    return ""


def _missed(run: Run, goal: str) -> Iterator[tuple[float, float, float, float]]:
    """Yield length [m], time [s], speed [m/s] and what is left [m] of each leg that ends too far from its waypoint."""
    points, (start, end) = run.waypoints(goal), run.period(goal)
    said, ended = run.all("feedback", goal), run.one("result", goal)
    for index, point in enumerate(points):
        own = [each["at"] for each in said if each["waypoint"] == index]
        later = [each["at"] for each in said if each["waypoint"] > index]
        if not own or (not later and (ended is None or ended["status"] != "SUCCEEDED")):
            continue
        since, until = (own[0] if index else start), (later[0] if later else end)
        here, there = (run.way[np.searchsorted(run.times, at).clip(0, len(run.times) - 1)] for at in (since, until))
        left = float(np.hypot(*(np.array(point) - there)))
        if left > MISSED:
            length = float(np.hypot(*(np.array(point) - here)))
            yield length, until - since, run.one("sent", goal)["speed"], left
