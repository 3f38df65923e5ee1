"""`spawned`: does the launch put a robot into the world, at the place that its arguments name?

kind = "spawned"
robot = "scout"           # name of the model
x = "x"                   # arguments of the launch: position [m] and heading [rad]; 0 if they are not given
y = "y"
yaw = "yaw"
within = 0.1              # optional: [m] and [rad]
"""

from __future__ import annotations

import math

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.feedback.predictions.of_robots.creating import at_work_on, description_meaning, misplaced
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.launched import (
    argument,
    complaint,
    deaths,
    declared,
    launch_facts,
    logged_error,
    looked_elsewhere,
)
from gz_course.grader.score.steps import told
from gz_course.sim.did_you_mean import nearest_name

LATE = 0.5  # [s] of simulated time


@check_kind("spawned")
def spawned(recording: Recording, parameters: Table) -> Finding:
    """Pass if the model is there from the beginning, where it was asked for."""
    robot, within = parameters.text("robot"), parameters.number("within", 0.1, above=0)
    names = {axis: parameters.text(axis) for axis in ("x", "y", "yaw")}
    given = {axis: argument(recording, name, "0") for axis, name in names.items()}
    called = given["x"][1]
    wanted = {axis: float(value) for axis, (value, _) in given.items()}
    at = f"x {told(wanted['x'])} m, y {told(wanted['y'])} m, heading {told(wanted['yaw'])} rad"
    expected = f"{called}: a model {robot} at {at}"
    found = {axis: recording.signal(f"truth/{robot}/{axis}") for axis in wanted}
    if not len(found["x"]):
        measured, why = _why_not(recording, robot)
        return Finding(False, expected, measured, explanation=why, nothing=True)
    first = float(found["x"].times[0]) / 1e9
    if first > LATE:
        return Finding(False, expected, f"{robot} came only at {told(first)} s", first)
    place = {axis: float(signal.values[0]) for axis, signal in found.items()}
    off = {axis: place[axis] - wanted[axis] for axis in wanted}
    off["yaw"] = math.remainder(off["yaw"], math.tau)
    wrong = [axis for axis in wanted if not abs(off[axis]) <= within]
    measured = f"{called} it was at x {told(place['x'])} m, y {told(place['y'])} m, heading {told(place['yaw'])} rad"
    if not wrong:
        return Finding(True, expected, measured)
    ignored = [axis for axis in wrong if abs(place[axis]) <= within]
    why = misplaced(wanted, place, wrong, names)
    if ignored == wrong and "converted" not in why:
        words = ", ".join(names[axis] for axis in wrong[:-1]) + " and " * (len(wrong) > 1) + names[wrong[-1]]
        why = f"the {'argument' if len(wrong) == 1 else 'arguments'} {words} had no effect on the place of {robot}"
        unknown = next(filter(None, (declared(recording, names[axis], "") for axis in wrong)), "")
        why = f"{why}: {unknown}" if unknown else why
    return Finding(False, expected, measured, explanation=why)


def _why_not(recording: Recording, robot: str) -> tuple[str, str]:
    """Return what is known of a model that never was in the world, and the misconception behind it."""
    others = sorted({name.split("/")[1] for name in recording.signals() if name.startswith("truth/")})
    calls = launch_facts(recording).get("calls", [])
    if others and "create: done" in calls:
        near = nearest_name(robot, others, 0.0) or others[0]
        return f"the world had no model {robot}, but {near}", f"create was not told the name {robot} (-name {robot})"
    said = logged_error(recording, "create") or complaint(recording, "create")
    died = next((each for each in deaths(recording) if each.process == "create"), None)
    publisher = next((each for each in deaths(recording) if each.process == "robot_state_publisher"), None)
    if publisher is not None:
        measured = f"robot_state_publisher ended with exit code {publisher.code}{publisher.words}"
        return measured, description_meaning(publisher.said)
    if died is not None or said:
        words = said or (died.said if died is not None else "")
        return f"create put no model into the world; it said: {words}", looked_elsewhere(words)
    if "create: done" not in calls and (parts := at_work_on(recording)):
        return "create was still at work on the robot when the run was over", parts
    if calls:
        return "Gazebo refused the model that create asked for", ""
    other = next(deaths(recording), None)
    ended = f"; {other.process} ended with exit code {other.code}{other.words}" if other is not None else ""
    return f"nothing asked Gazebo to create a model: create of ros_gz_sim does that{ended}", ""
