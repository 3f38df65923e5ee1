"""`final_pose`: is a model where it should be at the end (or at another time)?

kind = "final_pose"
model = "robot"
near = [2.0, 1.0]         # x, y or x, y, z [m] in the world's frame, with
radius = 0.25             # the largest distance [m]; or a box instead of the two:
x = [1.5, 2.5]
y = [0.5, 1.5]
heading = 1.57            # optional: [rad] about the upward axis, full turns ignored, with
tolerance = 0.2           # the largest deviation [rad]
at = 7.0                  # [s], optional: another time than the end

A robot that never moved may be there as well: give such a check a gate, or let the trials begin elsewhere.
"""

from __future__ import annotations

import math

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Band, Finding, check_kind
from gz_course.grader.score.steps import told, value_at

AXES = "xyz"


@check_kind("final_pose")
def final_pose(recording: Recording, parameters: Table) -> Finding:
    """Pass if the model's true position, and its heading if asked for, are in the region at that time."""
    model = parameters.text("model")
    at = parameters.number("at", recording.properties("run")["duration"], above=0)
    near = parameters.numbers("near", [2, 3]) if parameters.has("near") else []
    radius = parameters.number("radius", above=0) if near else math.inf
    box = {axis: parameters.numbers(axis, [2]) for axis in AXES if parameters.has(axis)}
    heading = parameters.number("heading") if parameters.has("heading") else None
    tolerance = parameters.number("tolerance", above=0) if heading is not None else math.inf
    if not near and not box and heading is None:
        parameters.refuse("near", "given, or x, y, z or heading instead of it")
    wanted = [f"within {radius:g} m of ({', '.join(f'{v:g}' for v in near)})"] if near else []
    wanted += [f"{axis} in {low:g} to {high:g} m" for axis, (low, high) in box.items()]
    wanted += [f"heading within {tolerance:g} rad of {heading:g} rad"] if heading is not None else []
    expected = f"{model}: {', '.join(wanted)} at {at:g} s"
    bands = tuple(Band(f"truth/{model}/{axis}", low, high, at, at) for axis, (low, high) in box.items())
    place = [value_at(recording, f"truth/{model}/{axis}", at) for axis in AXES]
    yaw = value_at(recording, f"truth/{model}/yaw", at)
    if None in place[:2] or at > recording.ended_s:
        ended = f"the simulation ended at {recording.ended_s:.2f} s"
        return Finding(False, expected, ended if at > recording.ended_s else "nothing is known of it", None, bands)
    here = [value or 0.0 for value in place]
    measured = f"it stood at ({', '.join(map(told, here[: max(2, len(near))]))})"
    distance = None
    passed = all(low <= here[AXES.index(axis)] <= high for axis, (low, high) in box.items())
    if near:
        away = distance = math.dist(near, here[: len(near)])
        passed = passed and away <= radius
        measured += f", {told(away)} m away"
    if heading is not None:
        # The recorded heading is unwrapped: it counts full turns.
        off = math.inf if yaw is None else abs(math.remainder(yaw - heading, 2 * math.pi))
        passed = passed and off <= tolerance
        distance = off if distance is None else distance
        measured += f", its heading {told(off)} rad off"
    return Finding(passed, expected, measured, round(at, 3), bands, value=distance)
