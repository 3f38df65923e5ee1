"""Why a goal beside or after the first one fails: it spoils the one under way, is refused, or goes elsewhere."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect

if TYPE_CHECKING:
    from .patrol_run import Run

MOVED = 0.25  # [m] from the start of a patrol: then its direction is known
STRAIGHT = 0.15  # [rad]
SOON = 0.6  # [s] after a second goal was accepted: who ends the patrol then ends it because of that goal
LONG = 3.0  # [s] without feedback
GOES = 0.03  # [m/s] a robot that is slower stands
THERE = 0.17  # [m] from a waypoint
MAX_SPEED = 0.5  # [m/s] if nobody sets the parameter
HEADED = {
    "waypoints are taken as seen from where the patrol begins; they are places in the frame odom": lambda p, c, s: p,
    "waypoints are taken as seen from the robot, and turned with its heading; they are places in the frame odom": (
        lambda p, c, s: np.column_stack((c * p[:, 0] - s * p[:, 1], s * p[:, 0] + c * p[:, 1]))
    ),
}


def spoilt(run: Run) -> str:
    """Return what a second goal did to the patrol under way; empty if the patrol went its way until its end."""
    taken, found = run.one("accepted", "second"), run.one("result", "patrol")
    if taken is None or (found is not None and found["at"] < taken["at"]):
        return ""
    if found is not None and found["at"] < taken["at"] + SOON and run.nearest("patrol", found["at"])[0] == 0:
        return f"the patrol under way ended as {found['status']} {max(0.0, found['at'] - taken['at']):.2f} s later"
    before = run.linear.values[(run.times > taken["at"] - SOON) & (run.times <= taken["at"])]
    after = run.linear.values[(run.times > taken["at"] + SOON) & (run.times <= run.period("patrol")[1])]
    if before.max(initial=0.0) > GOES and len(after) and np.abs(after).max() < GOES:
        return "the robot stopped then, and the patrol under way went no further"
    if follows(run, taken["at"]):
        return "the robot left the patrol under way for its waypoint"
    said = run.all("feedback", "patrol")
    if found is None and said and said[-1]["at"] < taken["at"] + SOON and run.end > taken["at"] + LONG:
        return "neither feedback nor a result of the patrol under way came after that"
    short = run.nearest("patrol", run.end)[0] < len(run.waypoints("patrol"))
    if found is None and short and run.end > taken["at"] + LONG and on_its_way(run, taken["at"]):
        return "the patrol under way was not driven to its end after that"
    return ""


def on_its_way(run: Run, at: float) -> Any:
    """Return whether the robot came nearer to its waypoint in the half second before a time [s]."""
    count, _ = run.nearest("patrol", at)
    point = np.array(run.waypoints("patrol")[min(count, len(run.waypoints("patrol")) - 1)])
    way = run.way[(run.times > at - 0.5) & (run.times <= at)]
    left = np.hypot(*(way - point).T)
    return len(left) > 1 and left[0] - left[-1] > GOES


def leftover(run: Run) -> str:
    """Return that the patrol after the cancelled one drives to a waypoint of that one first; empty if it does not."""
    found, cancelled = run.one("result", "again"), run.one("result", "cancelled")
    if run.one("accepted", "again") is None or cancelled is None:
        return ""
    start, end = run.period("again")
    way = run.way[(run.times >= start) & (run.times <= end)]
    before = run.way[run.times <= cancelled["at"]]
    others = [("cancelled", point) for point in run.waypoints("cancelled")]
    if found is None:  # it goes somewhere: all the way of the first patrol is no chance
        others = [("first", run.waypoints("patrol")[0])] if _all_reached(way, run.waypoints("patrol")) else []
    for which, point in others:
        if not len(way) or (found is not None and np.hypot(*(before - point).T).min() <= THERE):
            continue
        ends = np.array([way[0], *run.waypoints("again")], dtype=float)
        if np.hypot(*(way - point).T).min() < THERE and _beside(point, ends) > 2 * THERE:
            said = suspect(run.recording, "anew", "kept_list")
            where = ", ".join(f"{value:g}" for value in point)
            return (
                f"The patrol after the cancelled one drives to ({where}), which is a waypoint of the {which} one: "
                f"{said or 'what was kept of that one has to be emptied where the next begins'}"
            )
    return ""


def _all_reached(way: np.ndarray, points: list[Any]) -> bool:
    """Return whether a way (n, 2) leads to all of several points, in their order."""
    for point in points:
        left = np.hypot(*(way - np.array(point)).T) if len(way) else np.array([np.inf])
        if left.min() > THERE:
            return False
        way = way[int(np.argmax(left <= THERE)) :]
    return len(points) > 1


def _beside(point: list[float], corners: np.ndarray) -> float:
    """Return how far a point is from the straight lines between corners (n, 2) [m]."""
    off = []
    for one, other in pairwise(corners):
        along = other - one
        share = np.clip((point - one) @ along / max(along @ along, 1e-9), 0.0, 1.0)
        off.append(float(np.hypot(*(point - one - share * along))))
    return min(off)


def follows(run: Run, since: float) -> bool:
    """Return whether the robot drives to the waypoint of the second goal after a time [s], and not to its own."""
    _, end = run.period("patrol")
    later = (run.times >= since) & (run.times <= end)
    way, place = run.way[later], np.array(run.waypoints("second")[0], dtype=float)
    if not len(way) or run.nearest("patrol", end)[0] == len(run.waypoints("patrol")):
        return False
    left = np.hypot(*(way - place).T)
    return left[-1] < THERE or (left[0] - left[-1] > 0.5 and _straight(way, place))


def _straight(way: np.ndarray, place: np.ndarray) -> bool:
    """Return whether the last half metre of a way leads straight to a place."""
    gone = np.hypot(*(way - way[-1]).T)
    return gone.max() > 0.5 and _apart(way[-1] - way[int(np.argmax(gone <= 0.5))], place - way[-1]) < STRAIGHT


def of_a_refused_goal(run: Run) -> str:
    """Return that the patrol under way is changed by a goal that was rejected; empty if it is not."""
    refused = run.one("rejected", "second")
    if refused is None or not follows(run, refused["at"]):
        return ""
    said = suspect(run.recording, "stored_goal")
    return (
        "A second goal was rejected, but the robot drives to its waypoint: what goal_callback is asked about must not "
        f"change the patrol under way{f'. In {said}' if said else ''}"
    )


def slowed(run: Run) -> tuple[float, float] | None:
    """Return the speed [m/s] that a patrol takes over from a second goal that was rejected, and when; else None."""
    refused = run.one("rejected", "second")
    if refused is None:
        return None
    since, (_, end) = refused["at"] + SOON, run.period("patrol")
    fastest = float(run.linear.values[(run.times >= since) & (run.times <= end)].max(initial=0.0))
    other, own = run.one("sent", "second")["speed"], run.one("sent", "patrol")["speed"]
    if abs(fastest - other) > 0.12 * other or abs(other - own) < 0.3 * own:
        return None
    return fastest, since


def of_a_refused_speed(run: Run) -> str:
    """Return why a patrol goes on at the speed of a goal that was rejected."""
    said = suspect(run.recording, "stored_goal")
    return (
        "A second goal was rejected, but the robot goes on at its speed: what goal_callback is asked about must not "
        f"change the patrol under way{f'. In {said}' if said else ''}"
    )


def refused(run: Run, goal: str) -> str:
    """Return for which other reason than a patrol under way a goal is refused; empty if none is known."""
    sent = run.one("sent", goal)
    trial = json.loads(run.recording.properties("run").get("trial_parameters", "{}"))
    fastest = float(trial.get("parameters", {}).get("server", {}).get("max_speed", MAX_SPEED))
    if len(sent["waypoints"]) == 1 and (said := suspect(run.recording, "goal_length")):
        return f"Your server rejects a goal with a single waypoint: {said}"
    if abs(sent["speed"] - fastest) < 1e-9 and (said := suspect(run.recording, "goal_limit")):
        return f"Your server rejects a goal with the speed {fastest:g}, which is max_speed itself: {said}"
    return ""


def headed(run: Run, goal: str) -> str:
    """Return what else the first waypoint of a goal was taken for, as the direction tells in which the robot went."""
    if run.one("accepted", goal) is None:
        return ""
    start, end = run.period(goal)
    chosen = (run.times >= start) & (run.times <= end)
    way, points = run.way[chosen], np.array(run.waypoints(goal), dtype=float)
    if not len(way):
        return ""
    gone = np.hypot(*(way - way[0]).T)
    if gone.max() < MOVED:
        return ""
    went, yaw = way[int(np.argmax(gone >= MOVED))] - way[0], run.heading[chosen][0]
    if _apart(went, points[0] - way[0]) < STRAIGHT:
        return ""
    for words, places in HEADED.items():
        if _apart(went, places(points, np.cos(yaw), np.sin(yaw))[0]) < STRAIGHT:
            return words
    return ""


def _apart(one: np.ndarray, other: np.ndarray) -> float:
    """Return the angle between two directions [rad]."""
    return abs(np.arctan2(one[0] * other[1] - one[1] * other[0], one @ other))


def of_a_later_goal(run: Run) -> str:
    """Return why a patrol after the first one goes elsewhere, or nowhere; empty if that is not known."""
    if said := suspect(run.recording, "anew"):
        return f"What is kept of one goal spoils the next one: {said}"
    words = headed(run, "again") or headed(run, "cancelled")
    if words:
        return f"The robot went elsewhere: {words}"
    said = suspect(run.recording, "one_side")
    return f"The robot drives on although it does not face the waypoint: {said}" if said else ""
