"""Why a goal after the first one fails: it is refused for another reason than a patrol under way, or goes elsewhere."""

import json

import numpy as np

from gz_course.grader.score.suspects import suspect

MOVED = 0.25  # [m] from the start of a patrol: then its direction is known
STRAIGHT = 0.15  # [rad]
MAX_SPEED = 0.5  # [m/s] if nobody sets the parameter
HEADED = {
    "waypoints are taken as seen from where the patrol begins; they are places in the frame odom": lambda p, c, s: p,
    "waypoints are taken as seen from the robot, and turned with its heading; they are places in the frame odom": (
        lambda p, c, s: np.column_stack((c * p[:, 0] - s * p[:, 1], s * p[:, 0] + c * p[:, 1]))
    ),
}


def refused(run, goal):
    """Return for which other reason than a patrol under way a goal is refused; empty if none is known."""
    sent = run.one("sent", goal)
    trial = json.loads(run.recording.properties("run").get("trial_parameters", "{}"))
    fastest = float(trial.get("parameters", {}).get("server", {}).get("max_speed", MAX_SPEED))
    if len(sent["waypoints"]) == 1 and (said := suspect(run.recording, "goal_length")):
        return f"Your server rejects a goal with a single waypoint: {said}"
    if abs(sent["speed"] - fastest) < 1e-9 and (said := suspect(run.recording, "goal_limit")):
        return f"Your server rejects a goal with the speed {fastest:g}, which is max_speed itself: {said}"
    return ""


def headed(run, goal):
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


def _apart(one, other):
    """Return the angle between two directions [rad]."""
    return abs(np.arctan2(one[0] * other[1] - one[1] * other[0], one @ other))


def of_a_later_goal(run):
    """Return why a patrol after the first one goes elsewhere, or nowhere; empty if that is not known."""
    if said := suspect(run.recording, "anew"):
        return f"What is kept of one goal spoils the next one: {said}"
    words = headed(run, "again") or headed(run, "cancelled")
    if words:
        return f"The robot went elsewhere: {words}"
    said = suspect(run.recording, "one_side")
    return f"The robot drives on although it does not face the waypoint: {said}" if said else ""
