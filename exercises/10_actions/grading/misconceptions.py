"""What a patrol looks like if its server has a common misconception; `patrol_checks.py` asks for those that fit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect

from . import bearings, distances, legs

if TYPE_CHECKING:
    from .patrol_run import Run

SLOW = 0.5  # [s] between two commands
LONG = 4.0  # [s] without a new command
NEAR = 0.17  # [m]
THERE = 0.13  # [m] from a waypoint
MOVED = 0.1  # [m] a robot that moved less stood
TOO_FAST = 1.4  # times the speed of the goal
STAYS = 0.4  # [m] from the last place


def went_elsewhere(run: Run, goal: str, until: float) -> str:
    """Return where the robot went instead of to the waypoints; empty if that is not known."""
    points = np.array(run.waypoints(goal))
    start, _ = run.period(goal)
    chosen = (run.times >= start) & (run.times <= until)
    way = run.way[chosen]
    if not len(way):
        return ""
    if np.hypot(*(way - way[0]).T).max() < MOVED:
        return stood(run, chosen)
    if words := bearings.backwards(run):
        return words
    if said := suspect(run.recording, "no_place", "summed_place", "heading", "angle"):
        return said
    if words := other_places(way, points):
        return f"The robot went elsewhere: {words}"
    if words := old_commands(run, goal, until):
        return words
    if said := suspect(run.recording, "one_axis"):
        return f"A waypoint counts as reached where the robot is not: {said}"
    if words := last_only(run, goal, way, points):
        return words
    return (
        blind(run, goal)
        or distances.believed(run, goal)
        or stays(run, goal)
        or bearings.driven_past(run, chosen, points)
        or bearings.wrong_bearing(run, chosen, points)
        or turned_wrong(run, chosen, points)
    )


def last_only(run: Run, goal: str, way: np.ndarray, points: np.ndarray) -> str:
    """Find out whether the robot went to the last waypoint and to none before it."""
    if len(points) < 2 or _reaches(way, points[:1]) or not _reaches(way, points[-1:]):
        return ""
    words = "The robot drove to the last waypoint only: "
    if why := suspect(run.recording, "left_out"):
        return words + why
    said, nearest = run.all("feedback", goal), np.hypot(*(way - points[0]).T).min()
    if said and said[0]["waypoint"] == 0 and said[-1]["waypoint"] == len(points) - 1:
        return (
            f"Your server takes the waypoint 0 for reached although the robot was never nearer to it than "
            f"{nearest:.2f} m: the condition by which a waypoint is reached holds too early; the distance, "
            "hypot(dx, dy), must be below 0.15 m"
        )
    return f"{words}the goal holds a list of them, to be visited one after another"


def old_commands(run: Run, goal: str, until: float) -> str:
    """Find out whether the server steers by an old place, or sends a command once and waits."""
    if said := suspect(run.recording, "old_pose"):
        return f"Your server steers by a place that the robot has left: {said}"
    start, _ = run.period(goal)
    times = run.recording.signal("topics/cmd_vel/linear/x").times / 1e9
    sent = int(np.sum((times >= start) & (times <= until)))
    if 0 < sent <= len(run.waypoints(goal)) and until - start > LONG:
        return (
            f"Your server sent {'1 command' if sent == 1 else f'{sent} commands'} in {until - start:.0f} s: a command "
            "that is computed once for each waypoint never changes; compute and publish it in each step of the loop"
        )
    pauses = np.diff(times[(times >= start) & (times <= until)])
    if len(pauses) > 3 and np.median(pauses) > SLOW:
        return (
            f"Your server sends a command every {np.median(pauses):.1f} s only, and the robot obeys each of them until "
            "the next one comes, so it turns and drives past its waypoint: wait 0.1 s or less in the loop"
        )
    return ""


def other_places(way: np.ndarray, points: np.ndarray) -> str:
    """Return what the waypoints were taken for, if a way leads to such places in their order; else nothing."""
    candidates = {
        "x and y of the waypoints are exchanged": points[:, ::-1],
        "y of the waypoints has the wrong sign: y grows to the left": points * (1, -1),
        "x of the waypoints has the wrong sign": points * (-1, 1),
        "each waypoint is taken as seen from the one before; waypoints are places in the frame odom": np.cumsum(
            points, 0
        ),
        "waypoints are taken as seen from where the patrol begins; they are places in the frame odom": points + way[0],
        "the waypoints are visited in the opposite order": points[::-1],
        "waypoints are taken for centimetres; they are in metres": points / 100,
        "waypoints are taken for millimetres; they are in metres": points / 1000,
    }
    for words, places in candidates.items():
        stays = np.hypot(*(way[-1] - places[-1])) < STAYS  # who drives on does not take that place for the last one
        if stays and not np.allclose(places, points) and _reaches(way, places):
            return words
    for how, whole in (
        ("rounded to whole metres, as by round()", np.round),
        ("cut to whole metres, as by int()", np.trunc),
    ):
        places = whole(points)  # often near the right ones, or on the way to them
        near = [np.hypot(*(way - point).T).min() < NEAR for point in points[np.abs(places - points).max(axis=1) > NEAR]]
        if near and not any(near) and np.hypot(*(way[-1] - places[-1])) < THERE and _reaches(way, places):
            return f"the coordinates of the waypoints are {how}"
    return ""


def _reaches(way: np.ndarray, places: np.ndarray) -> bool:
    """Return whether a way (n, 2) leads to all places (m, 2), in their order, to 0.12 m, and not all by its start."""
    if np.hypot(*(places - way[0]).T).max() < 0.3:
        return np.hypot(*(way - way[0]).T).max() < 0.3 and bool(np.hypot(*(way[-1] - places[-1])) < 0.12)
    for place in places:
        left = np.hypot(*(way - place).T)
        if left.min() > 0.12:
            return False
        way = way[int(np.argmax(left <= 0.12)) :]
    return True


def stood(run: Run, chosen: np.ndarray) -> str:
    """Return why the robot did not move from its place."""
    turned = np.abs(run.angular.values[chosen]).max(initial=0.0)
    commands = run.recording.signal("topics/cmd_vel/linear/x")
    if not len(commands):
        said = suspect(run.recording, "hidden") or "execute did not come to a publish()"
        return f"No command came on /cmd_vel while the patrol was under way: {said}"
    if turned > 0.2:
        return suspect(run.recording, "heading", "angle") or (
            "The robot turned on the spot and never drove: your server never finds that it faces the waypoint, so its "
            "heading, or the direction to the waypoint, atan2(dy, dx), is wrong, or the loop does not see /odom change"
        )
    return ""


def turned_wrong(run: Run, chosen: np.ndarray, points: np.ndarray) -> str:
    """Find out whether the robot turns away from the first waypoint that it misses."""
    way, yaw = run.way[chosen], run.heading[chosen]
    missed = next((p for p in points if np.hypot(*(way - p).T).min() > 0.17), points[-1])
    after = 0
    for point in points:
        if np.allclose(point, missed):
            break
        after = int(np.argmax(np.hypot(*(way - point).T) <= 0.17))
    beside = missed - way[after:]
    error = np.remainder(np.arctan2(beside[:, 1], beside[:, 0]) - yaw[after:] + np.pi, 2 * np.pi) - np.pi
    rate = run.angular.values[chosen][after:]
    whole = np.abs(np.diff(yaw)).sum() / (2 * np.pi)
    if whole > 1.5 and (said := suspect(run.recording, "wrap")):
        return f"The robot turned around {whole:.1f} times: {said}"
    clear = (np.abs(error) > 0.3) & (np.abs(error) < 2.6) & (np.abs(rate) > 0.1)
    if clear.sum() >= 10 and np.mean(np.sign(error[clear]) != np.sign(rate[clear])) > 0.85:
        return (
            "The robot turns away from the waypoint: a positive angular.z turns to the left, and the angle to turn by "
            "is atan2(dy, dx) - heading"
        )
    if clear.sum() < 10 and np.mean(np.abs(error) > 0.3) > 0.5 and np.abs(rate).max(initial=0.0) < 0.05:
        said = suspect(run.recording, "phase")
        return (
            "The robot never turns towards the waypoint: "
            f"{said or 'angular.z stays 0 although the waypoint is beside it'}"
        )
    return ""


def blind(run: Run, goal: str) -> str:
    """Find out whether the server sees the same place again and again although the robot moves."""
    said = run.all("feedback", goal)
    if len(said) >= 5 and len({each["distance"] for each in said}) == 1:
        if kept := suspect(run.recording, "first_kept", "old_pose"):
            return f"The server takes the robot to be where it was at first: {kept}"
        return (
            "The patrol never ended: the loop in execute does not see where the robot is, because its distance never "
            "changes: it must read the place again in every iteration, the callback of /odom must keep it, and while "
            "the loop runs, /odom needs a thread of its own, that of a MultiThreadedExecutor"
        )
    return ""


def stays(run: Run, goal: str) -> str:
    """Find out whether a server drives on to a waypoint at which the robot was: it asks for something else."""
    points = np.array(run.waypoints(goal), dtype=float)
    said = [each for each in run.all("feedback", goal) if 0 <= each["waypoint"] < len(points)]
    places = np.searchsorted(run.times, [each["at"] for each in said]).clip(0, len(run.times) - 1)
    left = [float(np.hypot(*(run.way[i] - points[e["waypoint"]]))) for i, e in zip(places, said, strict=True)]
    right = [abs(one - each["distance"]) < 0.1 for one, each in zip(left, said, strict=True)]
    near = [each for one, each in zip(left, said, strict=True) if one < THERE]
    if not near or np.mean(right) < 0.8 or said[-1]["at"] < near[0]["at"] + LONG / 2:
        return ""
    if said[-1]["waypoint"] != near[0]["waypoint"]:
        return ""
    return (
        f"The robot was {min(left):.2f} m from the waypoint {near[0]['waypoint']}, but your server drives on to it: "
        "within 0.15 m it is reached, and the condition in your loop asks for something else"
    )


def reached_early(run: Run, goal: str) -> str:
    """Find out whether a patrol ended, or a waypoint was left, too far away."""
    found, points = run.one("result", goal), run.waypoints(goal)
    start, end = run.period(goal)
    fastest = float(run.linear.values[(run.times >= start) & (run.times <= end)].max(initial=0.0))
    if fastest > TOO_FAST * (asked := run.one("sent", goal)["speed"]):
        return (
            f"Your server drives at {fastest:.2f} m/s where the goal says {asked:.2f}, and misses its waypoints: "
            "linear.x must not be more than the speed of the goal"
        )
    if found is None:
        return ""
    way = run.way[(run.times >= start) & (run.times <= end)]
    axis = suspect(run.recording, "one_axis")
    axis = f"A waypoint counts as reached where the robot is not: {axis}" if axis else ""
    if not len(way) or np.hypot(*(way - way[0]).T).max() < MOVED:
        return axis or (
            f"The patrol ended as {found['status']} before the robot had moved: "
            + (
                suspect(run.recording, "inverted")
                or "either the condition of the loop that drives is false at once, or what ends the patrol comes "
                "before the robot has arrived"
            )
        )
    if words := other_places(way, np.array(points)):
        return f"The robot went elsewhere: {words}"
    near = [float(np.hypot(*(way - point).T).min()) for point in points]
    if words := legs.left_by_time(run):
        return words
    if words := axis or last_only(run, goal, way, np.array(points)):
        return words
    if max(near) < 0.6 and (words := distances.by_reckoning(run, goal)):
        return words
    if max(near) < 0.6:
        why = suspect(run.recording, "squared")
        return (
            f"Your server counts a waypoint as reached too early: {max(near):.2f} m was the nearest, and 0.15 m is "
            f"asked for{f': {why}' if why else ''}"
        )
    if near[0] < 0.2 and len(points) > 1 and np.hypot(*(way[-1] - points[0])) < 0.3:
        why = suspect(run.recording, "left_early", "left_out")
        if not why and any(each["waypoint"] == len(points) - 1 for each in run.all("feedback", goal)):
            why = "its index goes on to the last one and the robot does not: drive to the waypoint with that index"
        why = why or (
            "the loop over the waypoints has to go on until the last one, and what says that one is reached must be "
            "set back for the next"
        )
        return f"The patrol ended as {found['status']} after the first waypoint: {why}"
    return ""


def bearing_of(run: Run, goal: str) -> str:
    """Return by which wrong angle the robot steers in a patrol after the first one; empty if none fits."""
    if run.one("accepted", goal) is None:
        return ""
    start, end = run.period(goal)
    chosen = (run.times >= start) & (run.times <= end)
    said = suspect(run.recording, "heading", "angle")
    return said or bearings.wrong_bearing(run, chosen, np.array(run.waypoints(goal), dtype=float))
