"""The checks of the patrol: what the dispatcher got from the action server, and what the robot really did.

The dispatcher's reports are in `given_node.py`. Waypoints are in the frame odom, which begins where the robot starts.
`misconceptions.py` says what a wrong patrol looks like.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding

from . import after_the_end, distances, later_goals, legs, misconceptions, pauses, refusals, speeds
from .counts import of_a_cancelled, other_visited
from .patrol_run import NEAR, Run

LARGEST_GAP = 1.1  # [s] between two feedback messages
TURNS_ON = 0.1  # [rad/s] when a patrol is over
STILL = 1.5  # [s] before the end of a run: who sends feedback then is still driving
STOPPED = 0.5  # [s] after the cancellation
GOALS = {goal: words for goal, (words, _) in refusals.GOALS.items()}


def gated(expected: str, why: str) -> Finding:
    return Finding(False, expected, why, gated=True)


def no_patrol(run: Run, expected: str) -> Any:
    """Return the finding if no patrol was ever accepted, else None."""
    found = run.one("interface")
    if found is None or found.get("fault"):
        return gated(expected, "the action Patrol cannot be used")
    if run.one("no_server"):
        return gated(expected, "nobody offers the action /patrol")
    return None if run.one("accepted", "patrol") else gated(expected, "no patrol was accepted")


def interface(recording: Recording, parameters: dict[str, Any]) -> Finding:
    run = Run(recording)
    found, expected = run.one("interface"), "Patrol with the fields of the task, and a server of /patrol"
    if found is None:
        return Finding(False, expected, "the dispatcher could not import patrol_interfaces.action")
    if found.get("fault"):
        return Finding(False, expected, found["fault"], found["at"], explanation=f"{sentence(found['fault'])}")
    if gone := run.one("no_server"):
        return Finding(
            False, expected, "nobody offers the action /patrol", gone["at"], explanation=other_name(recording)
        )
    return Finding(True, expected, "all fields have their types")


def other_name(recording: Recording) -> str:
    """Return under which other name an action is offered; empty if none is."""
    ends = recording.facts().get("endpoints", [])
    found = [e for e in ends if e["kind"] == "publisher" and e["topic"].endswith("/_action/status")]
    if not found:
        return ""
    name = found[0]["topic"].removesuffix("/_action/status")
    private = f"; the ~ in its name stands for {found[0]['node']}" if name.startswith(f"{found[0]['node']}/") else ""
    return f"Your server offers the action {name}, not /patrol{private}"


def sentence(text: str) -> Any:
    return text[:1].upper() + text[1:]


def rejects(recording: Recording, parameters: dict[str, Any]) -> Finding:
    run, expected = Run(recording), "REJECT for each goal that cannot be done"
    if (gate := no_patrol(run, expected)) and not any(run.one("accepted", goal) for goal in GOALS):
        if run.one("rejected", "patrol"):
            why = "Your server rejects every goal, a patrol that can be done, too"
            if any("did not return a GoalResponse" in line.text for line in recording.lines("log/student")):
                why += (
                    ": goal_callback must return GoalResponse.ACCEPT or GoalResponse.REJECT, and returns something else"
                )
            elif said := suspect(recording, "refuses_all"):
                why += f": {said}"
            return Finding(False, expected, "a good goal was rejected, too", explanation=why)
        return gate
    for goal, words in GOALS.items():
        if event := run.one("accepted", goal):
            why = refusals.accepted(run)
            return Finding(False, expected, f"your server accepted {words}", event["at"], explanation=why)
        if not run.one("rejected", goal):
            return Finding(False, expected, f"your server never answered to {words}")
    return Finding(True, expected, "each of the four was rejected")


def visits(recording: Recording, parameters: dict[str, Any]) -> Finding:
    run, expected = Run(recording), "every waypoint within 0.15 m, in the order of the goal; then the robot stands"
    if gate := no_patrol(run, expected):
        return gate
    _, end = run.period("patrol")
    count, left = run.nearest("patrol", end)
    total = len(run.waypoints("patrol"))
    over = ("patrol is over: " + after_the_end.obeys(run, end, end + 0.5)) if count == total else ""
    if count == total and (turning := after_the_end.drives_on(run, run.angular.values)) > TURNS_ON:
        words = f"The robot turns on when the {over}"
        return Finding(False, expected, f"{turning:.2f} rad/s after the end", end, explanation=words)
    if count == total and (moving := after_the_end.drives_on(run, run.linear.values)) > 0.03:
        words = f"The robot drives on when the {over}"
        return Finding(False, expected, f"{moving:.2f} m/s after the end", end, explanation=words)
    if count == total:
        return Finding(True, expected, f"{total} of {total} waypoints")
    if later_goals.spoilt(run):
        return gated(expected, "a second goal was accepted before the patrol was driven to its end")
    why = later_goals.of_a_refused_goal(run) or misconceptions.reached_early(run, "patrol")
    still = not run.linear.values[(run.times > run.period("patrol")[0]) & (run.times < end)].any()
    if still and run.one("result", "patrol") is None and not run.all("feedback", "patrol"):
        why = (
            "Your server accepted a patrol, then neither feedback nor a result came: execute waits for something that "
            "cannot happen meanwhile"
        )
    why = why or misconceptions.went_elsewhere(run, "patrol", end)
    return Finding(
        False, expected, f"{count} of {total}; {left:.2f} m was the nearest to the next", end, explanation=why
    )


def speed(recording: Recording, parameters: dict[str, Any]) -> Finding:
    run, expected = Run(recording), "the speed of the goal on the straight"
    if gate := no_patrol(run, expected):
        return gate
    measured, fastest_of = "", dict[str, float]()
    for goal in ("patrol", "cancelled"):
        if not run.one("accepted", goal):
            continue
        start, end = run.period(goal)
        values = run.linear.values[(run.times >= start) & (run.times <= end)]
        fastest, wanted = float(np.max(values, initial=0.0)), run.one("sent", goal)["speed"]
        if fastest < 0.02 and any(each > 0.02 for each in fastest_of.values()):
            continue  # it never set off, which is no matter of speed
        fastest_of[goal] = fastest
        right = 0.85 * wanted <= fastest <= 1.12 * wanted
        if not measured or not right:
            measured, at, passed = f"{fastest:.2f} m/s where {wanted:.2f} m/s was asked for", start, right
    if passed and (slower := later_goals.slowed(run)):
        wanted = run.one("sent", "patrol")["speed"]
        measured = f"{slower[0]:.2f} m/s after a second goal was rejected, where {wanted:.2f} m/s was asked for"
        return Finding(False, expected, measured, slower[1], explanation=later_goals.of_a_refused_speed(run))
    driven = any(fastest > 0.02 for fastest in fastest_of.values())
    why = "" if passed or not driven else speeds.other_speed(run, fastest_of)
    return Finding(passed, expected, measured, None if passed else at, explanation=why)


def feedback(recording: Recording, parameters: dict[str, Any]) -> Finding:
    run, expected = Run(recording), "at least once a second: the right waypoint, and the distance left to it"
    if gate := no_patrol(run, expected):
        return gate
    said, (start, end) = run.all("feedback", "patrol"), run.period("patrol")
    points = run.waypoints("patrol")

    def wrong(measured: str, at: float, why: str = "") -> Finding:
        return Finding(False, expected, measured, at, explanation=why)

    if run.nearest("patrol", end)[0] < len(points):
        return gated(expected, "the patrol was not driven to its end")
    if not said:
        why = suspect(recording, "feedback")
        if suspect(recording, "no_feedback"):
            why = "Your server never calls publish_feedback"
        return wrong("no feedback came", end, why)
    if all(each["at"] > end - 0.3 for each in said):
        return wrong("it came at the end only", end, "Your feedback comes only when the patrol is over")
    times = [start, *(each["at"] for each in said), end]
    gap = max(later - sooner for sooner, later in pairwise(times))
    if gap > LARGEST_GAP:
        why = endless(run) or pauses.rare(run, said, start, end)
        return wrong(f"{gap:.1f} s without feedback", end, why)
    if len({(each["waypoint"], each["distance"]) for each in said}) == 1:
        return wrong("it was always the same", end, "Your feedback never changes: compute it again in every iteration")
    indices = [each["waypoint"] for each in said]
    if (indices[0], indices[-1]) == (1, len(points)):
        return wrong(f"waypoint was {indices[0]} first", times[1], "Your feedback counts the waypoints from 1")
    if indices != sorted(indices) or (indices[0], indices[-1]) != (0, len(points) - 1):
        return wrong(
            f"waypoint went from {indices[0]} to {indices[-1]}",
            times[1],
            legs.goes_on(run) or other_index(indices, len(points)),
        )
    off = 0
    for each in said:
        here = run.way[np.searchsorted(run.times, each["at"]).clip(0, len(run.times) - 1)]
        left = float(np.hypot(*(here - np.array(points[each["waypoint"]]))))
        off += abs(left - each["distance"]) > 0.15
    if off > 0.1 * len(said):
        why = distances.other_distance(run, said, points)
        return wrong(f"{off} of {len(said)} distances were wrong by more than 0.15 m", times[1], why)
    return Finding(True, expected, f"{len(said)} messages")


def other_index(indices: list[int], total: int) -> str:
    """Return what else the numbers of the waypoints in the feedback are; empty if that is not known."""
    if len(set(indices)) == 1:
        return f"waypoint of your feedback is always {indices[0]}: it is the index of the waypoint the robot drives to"
    if indices == sorted(indices, reverse=True):
        return "waypoint of your feedback counts down, as if it were how many are left: it is an index, from 0"
    if indices == sorted(indices) and indices[-1] > total and np.mean(np.diff(indices) > 0) > 0.8:
        return "waypoint of your feedback counts iterations of the loop: it is the index of the waypoint in hand"
    return ""


def still_driving(run: Run, goal: str) -> str:
    """Return that a patrol goes on although the robot is at the last waypoint; empty if that is not so."""
    said = run.all("feedback", goal)
    if not said or said[-1]["at"] < run.end - STILL or not 0 <= said[-1]["distance"] < NEAR:
        return ""
    return (
        f"The robot is at the last waypoint, but the loop in execute goes on: its distance is still "
        f"{said[-1]['distance']:.3f} m, and the condition of the loop asks for something else than within 0.15 m"
    )


def endless(run: Run) -> str:
    """Return why a patrol that was driven to its end has no result; empty if it has one, or was not driven."""
    if run.one("result", "patrol") is not None or run.nearest("patrol", run.end)[0] < len(run.waypoints("patrol")):
        return ""
    if words := legs.goes_on(run):
        return words
    driving = run.recording.signal("topics/cmd_vel/linear/x").times / 1e9
    if len(driving) and driving[-1] > run.end - 0.5 and not still_driving(run, "patrol"):
        return (
            "The robot has been at all waypoints, but no result came until the end of the run, and commands still "
            "come: the loop in execute goes on"
        )
    why = suspect(run.recording, "unsent_result") or (
        "execute must call goal_handle.succeed() and return a Patrol.Result (a function without return returns None, "
        "which is no result)"
    )
    return still_driving(run, "patrol") or f"The patrol was driven to its end, but no result came: {why}"


def result(recording: Recording, parameters: dict[str, Any]) -> Finding:
    run, expected = Run(recording), "SUCCEEDED, with the number of waypoints"
    if gate := no_patrol(run, expected):
        return gate
    found, total = run.one("result", "patrol"), len(run.waypoints("patrol"))
    if found is None and (why := endless(run)):
        return Finding(False, expected, "no result came", explanation=why)
    if found is None:
        return gated(expected, "no result came")
    if run.nearest("patrol", found["at"])[0] < total:
        return gated(expected, "the patrol was not driven to its end")
    measured = f"{found['status']}, visited = {found['visited']}"
    why = ""
    if found["status"] == "ABORTED":
        why = "The patrol was driven to its end, but ended as ABORTED: "
        why += suspect(recording, "ended") or "nothing called goal_handle.succeed()"
    elif found["status"] == "SUCCEEDED" and found["visited"] == 0:
        why = "visited of your result is 0, as if it were not filled in, although the robot has been everywhere"
    elif found["status"] == "SUCCEEDED" and found["visited"] != total:
        why = legs.goes_on(run) or other_visited(run, found, total)
    passed = found["status"] == "SUCCEEDED" and found["visited"] == total
    return Finding(passed, expected, measured, found["at"], explanation=why)


def busy(recording: Recording, parameters: dict[str, Any]) -> Finding:
    run, expected = Run(recording), "a goal is rejected during a patrol, and accepted after it"
    if gate := no_patrol(run, expected):
        return gate
    if event := run.one("accepted", "second"):
        so = suspect(recording, "queued") or later_goals.spoilt(run)
        why = f"Your server accepts a second goal during a patrol, which it must reject; {so}" if so else ""
        return Finding(False, expected, "a second goal was accepted during a patrol", event["at"], explanation=why)
    if not run.one("rejected", "second"):
        return gated(expected, "nobody answered to a second goal")
    for goal in ("cancelled", "again"):
        if event := run.one("rejected", goal):
            ended = run.one("result", "patrol")
            succeeded = ended is not None and ended["status"] == "SUCCEEDED"
            after = (
                f"a patrol had {'succeeded' if succeeded else 'ended'}" if goal == "cancelled" else "one was cancelled"
            )
            why = later_goals.refused(run, goal) or (
                f"Your server rejects every goal after {after}: the flag that says it is busy is not cleared then"
            )
            return Finding(False, expected, f"a goal was rejected after {after}", event["at"], explanation=why)
        if not run.one("accepted", goal):
            return gated(expected, "an earlier patrol did not end")
    found = run.one("result", "again")
    if found is None:
        measured = "the patrol after the cancelled one did not end"
        why = still_driving(run, "again") or later_goals.leftover(run) or later_goals.of_a_later_goal(run)
        return Finding(False, expected, measured, run.end, explanation=why or misconceptions.bearing_of(run, "again"))
    passed = found["status"] == "SUCCEEDED" and run.nearest("again", found["at"])[0] == len(run.waypoints("again"))
    measured = f"the patrol after the cancelled one ended as {found['status']}"
    why = "" if passed else later_goals.of_a_later_goal(run) or misconceptions.reached_early(run, "again")
    why = later_goals.leftover(run) or why
    passed = passed and not why
    return Finding(passed, expected, measured, found["at"], explanation=why)


def cancel(recording: Recording, parameters: dict[str, Any]) -> Finding:
    run, expected = Run(recording), "the robot stands within 0.5 s, and the goal ends as CANCELED"
    if gate := no_patrol(run, expected):
        return gate
    asked = run.one("cancel", "cancelled")
    if asked is None:
        return gated(expected, "no goal was there to be cancelled")
    at = asked["at"]
    if (early := run.one("result", "cancelled")) is not None and early["at"] < at:
        measured = f"it ended as {early['status']} {at - early['at']:.1f} s before it was to be cancelled"
        why = later_goals.of_a_later_goal(run) or misconceptions.reached_early(run, "cancelled")
        return Finding(False, expected, measured, early["at"], explanation=why)
    before = run.linear.values[(run.times > at - 1.0) & (run.times <= at)]
    if np.max(before, initial=0.0) < 0.05:
        return gated(expected, "the robot did not drive when the goal was cancelled")
    if run.one("not_cancelling", "cancelled"):
        said = suspect(recording, "refuses_cancel")
        why = f": {said}" if said else ", which is the default: its cancel_callback must accept (CancelResponse)"
        why = f"Your server refuses to cancel{why}"
        return Finding(False, expected, "the cancellation was refused", at, explanation=why)
    found = run.one("result", "cancelled")
    speed_then, turning = after_the_end.after_cancel(run, at + STOPPED, at + STOPPED + 0.5)
    moving, rate = after_the_end.after_cancel(run, at + STOPPED, run.end)
    if moving > 0.03 and found is not None and found["at"] < at + STOPPED:
        why = f"The goal ended, but the robot drove on: {after_the_end.obeys(run, found['at'], at + STOPPED + 0.5)}"
        return Finding(False, expected, f"{moving:.2f} m/s after the goal had ended", at + STOPPED, explanation=why)
    if moving > 0.03 or rate > TURNS_ON:
        why = after_the_end.ends_late(run, found, at)
        measured = f"{speed_then:.2f} m/s half a second later"
        if speed_then <= 0.03:
            measured += f", {turning:.2f} rad/s, and up to {moving:.2f} m/s after that"
        return Finding(False, expected, measured, at + STOPPED, explanation=why)
    if found is None:
        why = (
            "The robot stands, but the goal never ended: when goal_handle.is_cancel_requested is true, execute calls "
            "goal_handle.canceled() and returns a result"
        )
        return Finding(False, expected, "the goal never ended", at, explanation=why)
    counts = {run.nearest("cancelled", at, near)[0] for near in (0.08, 0.12, NEAR)}
    measured = f"{found['status']}, visited = {found['visited']}"
    why = ""
    if found["status"] != "CANCELED":
        called = "goal_handle.succeed() was called" if found["status"] == "SUCCEEDED" else "no state was set"
        said = suspect(recording, "cancel") or f"{called} where goal_handle.canceled() belongs"
        why = f"The cancelled goal ended as {found['status']}: {said}"
    elif found["visited"] not in counts:
        why = later_goals.of_a_later_goal(run) or of_a_cancelled(run, found, counts)
    passed = found["status"] == "CANCELED" and found["visited"] in counts
    return Finding(passed, expected, measured, found["at"], explanation=why)
