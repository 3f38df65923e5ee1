"""What `visited` of a result counts, if it is not the waypoints at which the robot has been."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect

if TYPE_CHECKING:
    from .patrol_run import Run

BEGIN_ANEW = "Make a new Result, and count from 0, in execute"


def of_a_cancelled(run: Run, found: dict[str, Any], counts: set[int]) -> str:
    """Return why `visited` of the cancelled patrol is wrong; `counts` are those that are right."""
    visited, fewest = found["visited"], min(counts)
    if _elsewhere(run):
        return ""  # what it counts are other places
    said = suspect(run.recording, "counted") if visited > max(counts) else ""
    goes_on = next(filter(None, (counts_on(run, found, count) for count in sorted(counts))), "")
    if goes_on and not said:
        return goes_on
    been = f"{fewest} of the waypoints when it was cancelled"
    if visited == 0:
        return (
            f"visited is 0, but the robot had been at {been}: the result that is returned there has to hold the count, "
            "too"
        )
    if visited < fewest:
        return f"visited is {visited}, but the robot had been at {been}"
    if said:
        return f"visited is {visited}, but the robot had been at {been}: {said}"
    if visited == max(counts) + 1:
        return (
            f"visited is {visited}, but the robot had been at {been}, and drove to the next: a waypoint counts when "
            "the robot has come to it"
        )
    return f"visited is {visited}, but the robot had been at {been}"


def _elsewhere(run: Run) -> bool:
    """Return whether the first patrol was driven, and not to its waypoints."""
    start, end = run.period("patrol")
    way = run.way[(run.times >= start) & (run.times <= end)]
    driven = float(np.hypot(*np.diff(way, axis=0).T).sum()) if len(way) > 1 else 0.0
    return driven > 0.5 and run.nearest("patrol", end)[0] < len(run.waypoints("patrol"))


def counts_on(run: Run, found: dict[str, int | str], count: int) -> str:
    """Find out whether `visited` of the cancelled patrol goes on from the patrol before; `count` is the right one."""
    before = run.one("result", "patrol")
    if before is None or not before["visited"] or found["visited"] != before["visited"] + count:
        return ""
    return (
        f"visited is {found['visited']}: the {before['visited']} of the patrol before and {count} of this one, because "
        f"the count goes on from goal to goal. {suspect(run.recording, 'result') or BEGIN_ANEW}"
    )


def other_visited(run: Run, found: dict[str, Any], total: int) -> str:
    """Return what `visited` of a patrol that was driven to its end counts."""
    if found["visited"] == total - 1:
        return (
            f"visited is {found['visited']}, one less than the {total} waypoints that the robot has been at, such as "
            "the index of the last waypoint, which counts from 0"
        )
    start, end = run.period("patrol")
    times = run.recording.signal("topics/cmd_vel/linear/x").times / 1e9
    rounds = max(len(run.all("feedback", "patrol")), int(np.sum((times >= start) & (times <= end))))
    if 3 * total < found["visited"] and 0.8 * rounds < found["visited"] < 1.2 * rounds:
        return f"visited is {found['visited']}, but {total} waypoints were visited: it counts the iterations of a loop"
    return f"visited is {found['visited']}, but the robot has been at all {total} waypoints"
