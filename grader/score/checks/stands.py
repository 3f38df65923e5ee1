"""`stands`: does a robot stay upright, on the ground and in its place until it is commanded to drive?

kind = "stands"
robot = "scout"           # name of the model
until = 1.0               # [s] of simulated time: it must not move before
settle = 0.4              # optional: [s] after it came, in which it may settle on the ground
tilt = 0.1                # optional: [rad] that it may lean at any time of the run
slide = 0.02              # optional: [m] that it may move between the two times, in any direction
drop = 0.1                # optional: [m] that it may fall, or be pushed up, in its whole run
"""

from __future__ import annotations

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.feedback.predictions.of_robots import standing
from gz_course.grader.feedback.predictions.of_robots.creating import odd_mass, overlap
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.launched import launch_facts
from gz_course.grader.score.robots import Robot, robot_of
from gz_course.grader.score.steps import told

WAY = ("x", "y", "z")
FALLS = "it falls over: nothing holds it up on that side"
LEANS = "it leans: it does not stand level"
SINKS = "it falls, or sinks into the ground"
TIPS = (
    "it stands, but tips over when it drives: its body has no mass (no <inertial>), its centre of mass is too high, or "
    "a wheel turns about another axis than its axle (a joint without <axis> turns about x)"
)
EXPLODES = (
    "it is thrown about faster than anything falls: physics explodes, as with a controller of huge gain, parts that "
    "overlap, or masses and inertias that are no body's"
)
FALLEN = 0.3  # [rad] a robot leans by at least that has fallen over
FASTEST = 15.0  # [rad/s] at which a robot may turn over; a small one that falls is slower
PUSHED = "something pushes it up: it starts inside the ground or another body, or its own parts overlap"


@check_kind("stands")
def stands(recording: Recording, parameters: Table) -> Finding:
    """Pass if the robot never leans far, falls or is thrown up, and rests until it is commanded to drive."""
    robot, until = parameters.text("robot"), parameters.number("until", above=0)
    settle, tilt = parameters.number("settle", 0.4, above=0), parameters.number("tilt", 0.1, above=0)
    slide, drop = parameters.number("slide", 0.02, above=0), parameters.number("drop", 0.1, above=0)
    expected = f"{robot} upright on the ground to the end, and at rest until {until:g} s"
    signals = {name: recording.signal(f"truth/{robot}/{name}") for name in (*WAY, "qx", "qy")}
    times = signals["z"].times / 1e9
    if not len(times):
        return Finding(False, expected, f"the world had no model {robot}")
    values = {name: signal.values for name, signal in signals.items()}
    leaning = 2 * np.arcsin(np.clip(np.hypot(values["qx"], values["qy"]), 0, 1))
    height = values["z"] - values["z"][0]
    resting = (times >= times[0] + settle) & (times <= until)
    moved = np.zeros(len(times))
    if resting.any():
        here = np.argmax(resting)
        moved = np.sqrt(sum((values[name] - values[name][here]) ** 2 for name in WAY)) * resting
    faults = [
        (leaning > tilt, leaning, "it leaned by {} rad at {} s", FALLS),
        (height < -drop, height, "its height had changed by {} m at {} s", SINKS),
        (height > drop, height, "its height had changed by {} m at {} s", PUSHED),
        (moved > slide, moved, "it had moved by {} m at {} s, before any command", "it does not rest where it stands"),
    ]
    found = [(int(np.argmax(wrong)), wrong, amount, said, why) for wrong, amount, said, why in faults if wrong.any()]
    if found:
        first, wrong, amount, said, why = min(found, key=lambda each: each[0])
        if why == FALLS and np.max(np.diff(leaning) / np.diff(times), initial=0.0) > FASTEST:
            why = EXPLODES
        elif why == FALLS and times[first] > until:
            why = TIPS
        elif why == FALLS and leaning.max() < FALLEN:
            why = LEANS
        if body := robot_of(recording, robot):
            warnings = launch_facts(recording).get("model_warnings", [])
            why = _of_its_parts(body, why, float(values["z"][0]), overlap(warnings, robot))
        worst = amount[np.argmax(np.abs(amount) * wrong)]
        at = float(times[first])
        return Finding(False, expected, said.format(told(float(worst)), told(at)), round(at, 3), explanation=why)
    if recording.ended_s < until:
        return Finding(False, expected, f"the simulation ended at {recording.ended_s:.2f} s")
    return Finding(True, expected, f"it leaned by at most {told(float(leaning.max()))} rad")


def _of_its_parts(body: Robot, why: str, height: float, pushes: str) -> str:
    """Return `why` more exactly, if the parts of a robot that came at `height` [m] prove the reason.

    `pushes` names parts that overlap.
    """
    said = ""
    if why in (FALLS, LEANS) and (said := standing.falls_over(body)):
        said = f"{why.partition(':')[0]}: {said}"
    elif why == TIPS and (said := standing.tips_over(body)):
        said = f"it stands, but tips over when it drives: {said}"
    elif why == SINKS:
        said = standing.without_collisions(body) or standing.above_the_ground(body, height)
    elif why == PUSHED:
        said = standing.in_the_ground(body, height)
    if not said and (said := odd_mass(body) or pushes):
        said = f"{why.partition(':')[0]}: {said}"
    return said or why
