"""`drives`: does a robot move as fast as commanded, and straight when that is commanded?

kind = "drives"
robot = "scout"           # name of the model
command = "cmd_vel"       # topic of the script (see grader/exercise/trial.py), without the slash before it
axis = "linear_x"         # or "angular_z": only what the script commands on this axis counts
settle = 0.5              # optional: [s] after each command, to get up to speed
within = 0.05             # optional: of the commanded speed, as a fraction
drift = 0.1               # optional: [rad] that it may turn on a straight line, [m] that it may move when it turns
wheels = "joint_states"   # optional: ROS topic of the joints, to tell whether the wheels turned at all
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.feedback.predictions.of_robots import driving
from gz_course.grader.feedback.predictions.of_robots.creating import overlap
from gz_course.grader.feedback.predictions.of_robots.topics import commands_elsewhere, why_not_carried
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording, Signal
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.graphs import bridges
from gz_course.grader.score.launched import launch_facts, logged_error
from gz_course.grader.score.robots import Robot, robot_of
from gz_course.grader.score.steps import told

AXES = {"linear_x": ("linear_x", "yaw", "m/s"), "angular_z": ("angular_z", "distance", "rad/s")}
TYPE = "geometry_msgs/msg/Twist"
STILL = 0.05  # of the commanded speed: less is no motion
LIFTED = 0.001  # [m] by which wheels that slip must be higher than the lowest part, so that it carries the robot
TURNED = 0.1  # [rad] that a wheel must turn to have moved


@check_kind("drives")
def drives(recording: Recording, parameters: Table) -> Finding:
    """Pass if the mean speed in each stretch of the script is the commanded one, and nothing else moves."""
    robot, topic = parameters.text("robot"), parameters.text("command")
    axis = parameters.choice("axis", tuple(AXES))
    settle, within = parameters.number("settle", 0.5, above=0), parameters.number("within", 0.05, above=0)
    drift = parameters.number("drift", 0.1, above=0)
    joints = parameters.text("wheels") if parameters.has("wheels") else ""
    signal, side, unit = AXES[axis]
    body = robot_of(recording, robot)
    speed, aside = recording.signal(f"truth/{robot}/{signal}"), recording.signal(f"truth/{robot}/{side}")
    commands = recording.signal(f"script/{topic}/{axis}")
    straight = axis == "linear_x"
    last = Finding(False, f"{robot} moves as commanded on /{topic}", "no command was given: the run ended before")
    for start, end, wanted in _stretches(commands, recording.ended_s, settle):
        moving, turning = _between(speed, start, end), _between(aside, start, end)
        name = "forward speed" if straight else "turning rate"
        expected = f"a {name} of {told(wanted)} {unit} from {start:g} to {end:g} s"
        if not len(moving):
            return Finding(False, expected, f"the world had no model {robot}", start)
        mean = float(moving.mean())
        measured = f"commanded {told(wanted)} {unit}, it had {told(mean)} {unit}"
        ratio, swerve = mean / wanted, float(np.ptp(turning))
        if abs(ratio - 1) > within:
            why = _silent(recording, topic) if abs(ratio) < STILL else ""
            if not why and abs(ratio) < STILL:
                why = _stuck(recording, body, topic, joints, start, end, swerve if straight else 0.0)
            pushes = overlap(launch_facts(recording).get("model_warnings", []), robot)
            why = why or (_linear if straight else _angular)(ratio, body, wanted, pushes)
            return Finding(False, expected, measured, start, explanation=why)
        if swerve > drift:
            if straight:
                measured += f", and turned by {told(swerve)} rad"
                why = "its wheels do not have the same radius or grip, or something drags on one side"
                why = f"it drives a curve: {(driving.unequal_wheels(body) if body else '') or why}"
            else:
                measured += f", and left the spot by {told(swerve)} m"
                why = "it does not turn about the middle between its wheels"
                if body and (where := driving.beside_the_middle(body)):
                    why = where
            return Finding(False, expected, measured, start, explanation=why)
        last = Finding(True, expected, measured, start)
    return last


def _stretches(commands: Signal, end: float, settle: float) -> Iterator[tuple[float, float, float]]:
    """Yield start and end [s] of every stretch in which the robot was to move, and the commanded speed."""
    times = [*(commands.times / 1e9), end]
    for start, stop, wanted in zip(times[:-1], times[1:], commands.values, strict=True):
        if wanted and start + settle < stop:
            yield round(float(start + settle), 3), round(float(stop), 3), float(wanted)


def _between(signal: Signal, start: float, end: float) -> np.ndarray:
    times = signal.times / 1e9
    return np.asarray(signal.values[(times >= start) & (times <= end)])


def _silent(recording: Recording, topic: str) -> str:
    """Return that the commands never arrived in Gazebo; empty if they did."""
    taken = recording.signal(f"script/{topic}/taken").values
    if taken.any():
        return ""
    why = why_not_carried(
        bridges(recording),
        f"/{topic}",
        TYPE,
        to_gz=True,
        said=logged_error(recording, "parameter_bridge"),
        remapped=recording.facts().get("remappings", []),
    )
    said = f"no bridge carried the commands on /{topic} ({TYPE}) from ROS to Gazebo"
    return f"{said}: {why}" if why else said


def _stuck(
    recording: Recording, body: Robot | None, topic: str, joints: str, start: float, end: float, swerve: float
) -> str:
    """Return why a robot that got its commands stays where it is."""
    if swerve > 0.5:
        return "commanded to drive straight, it turned on the spot: the axes of its wheels point in opposite directions"
    said = launch_facts(recording).get("model_warnings", [])
    if driver := next((text for text in said if "DiffDrive" in text or "left out" in text), ""):
        absent = "names joint" in driver and "did you mean" not in driver
        merged = "; a joint of type fixed is merged with the link it hangs on: a wheel's joint is continuous"
        return f"gz sim says of the robot: {shown(driver, 300)}{merged if absent else ''}"
    if body and (elsewhere := commands_elsewhere(body, bridges(recording), f"/{topic}")):
        return f"its wheels did not turn: {elsewhere}"
    why = driving.does_not_drive(body) if body else ""
    if body and why == driving.no_plugin(body) != "":
        return f"its wheels did not turn: {why}"
    if not joints:
        return "it did not move"
    times, positions = recording.arrays(f"topics/{joints}/position")
    rows = [row for time, row in zip(times / 1e9, positions, strict=True) if start <= time <= end]
    if len({len(row) for row in rows}) != 1:
        return why or "it did not move, and no states of its joints came to tell whether its wheels turned"
    if np.ptp(np.array(rows), axis=0).max(initial=0.0) < TURNED:
        if why:
            return f"its wheels did not turn: {why}"
        if body and (radius := driving.other_radius(body)):
            return f"its wheels hardly turned: {radius}"
        return (
            "its wheels did not turn: no plugin drives them, or the plugin listens to another topic or drives joints "
            "of other names"
        )
    lifted = (driving.slippery(body) or driving.hangs(body, LIFTED)) if body else ""
    more = why or lifted or "they turn about the wrong axis, or hang in the air"
    return f"its wheels turned, but did not roll along the ground: {more}"


def _linear(ratio: float, body: Robot | None, wanted: float, pushes: str) -> str:
    """Return why a robot is `ratio` times as fast as the `wanted` speed; `pushes` names parts of it that overlap."""
    if abs(ratio + 1) < 0.2:
        return "it drives backwards: the axes of both wheels point the wrong way (to the left is forward)"
    if ratio < 0:
        return "it drives backwards, and at another speed"
    if why := (driving.other_speed(body, wanted, ratio) if body else "") or pushes:
        return f"it drives {told(ratio)} times as fast as commanded: {why}"
    if body and ratio < 1 and driving.has_the_radius(body):
        return (
            f"it drives {told(ratio)} times as fast as commanded, and <wheel_radius> is right: its weight, too little "
            "grip, or a part that drags holds it back"
        )
    return (
        f"it drives {told(ratio)} times as fast as commanded: the plugin's <wheel_radius> is {told(1 / ratio)} times "
        "the radius of its wheels, or a limit of the plugin, the weight or the grip holds it back"
        if ratio < 1
        else f"it drives {told(ratio)} times as fast as commanded: the plugin's <wheel_radius> is {told(1 / ratio)} "
        "times the radius of its wheels"
    )


def _angular(ratio: float, body: Robot | None, wanted: float, pushes: str) -> str:
    why = (driving.turns_slowly(body, wanted) if body else "") or pushes
    if abs(ratio) < STILL:
        return f"it did not turn: {why}" if why else "it did not turn"
    if ratio < 0:
        if body and (where := driving.sides_exchanged(body)):
            return f"it turns the wrong way: the sides are exchanged: {where}"
        return "it turns the wrong way: <left_joint> and <right_joint> of the plugin are exchanged, or the wheels are"
    if why and (ratio < 1 or why == pushes or "wheel_separation" in why):
        return f"it turns {told(ratio)} times as fast as commanded: {why}"
    more = ", or something holds it back: a caster that grips the ground" if ratio < 1 else ""
    return (
        f"it turns {told(ratio)} times as fast as commanded: the plugin's <wheel_separation> is {told(ratio)} times "
        f"the distance of its wheels{more}"
    )
