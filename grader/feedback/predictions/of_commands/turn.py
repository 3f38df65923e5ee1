"""Wrong turns: too strong, too weak, to the other side, for another time than the drive."""

from __future__ import annotations

import math

import numpy as np

from gz_course.grader.feedback.predictions.commands import Drive, explains

SLIGHT = 0.33  # [rad/s] a turn up to this is slight
STRONG = 0.8  # [rad/s] more is a turn nearly on the spot
DEGREES = 3.0  # [rad/s] more looks like degrees: half a turn each second was hardly meant
# Values [rad/s] that are angles -> their names.
ANGLES = {math.pi: "pi, 180", math.pi / 2: "pi/2, 90", math.pi / 3: "pi/3, 60", math.pi / 4: "pi/4, 45"}


def turning(drive: Drive) -> np.ndarray:
    """Return angular.z of the commands that drive, or of all if none does."""
    return np.asarray(drive.angular[drive.moving, 2] if drive.moving.any() else drive.angular[:, 2])


def _near(value: float, wanted: float) -> bool:
    return abs(value - wanted) <= 0.02 * abs(wanted) + 1e-6


def _strength(drive: Drive) -> float:
    values = turning(drive)
    return float(np.median(np.abs(values))) if len(values) else 0.0


@explains
def grows(drive: Drive) -> str:
    """Find angular.z that grows or falls from command to command."""
    values = turning(drive)
    if len(values) < 6 or np.ptp(values) < 0.1 or np.ptp(values) < 0.3 * np.abs(values).max():
        return ""
    steps = np.diff(values)
    if max(np.mean(steps > 1e-4), np.mean(steps < -1e-4)) < 0.7:
        return ""
    return (
        f"angular.z goes from {values[0]:.2f} to {values[-1]:.2f} rad/s in the drive: it is a rate, not an angle or a "
        "sum, and stays the same for a steady turn"
    )


@explains
def varies(drive: Drive) -> str:
    """Find angular.z that rises and falls smoothly in the drive, as a sine of the time does."""
    values = turning(drive)
    if len(values) < 8 or grows(drive) or len(np.unique(np.round(values, 3))) < 0.7 * len(values):
        return ""
    if np.ptp(values) < 0.1 or ((values > 0.01).any() and (values < -0.01).any()):
        return ""
    return (
        f"angular.z changes from command to command, between {values.min():.2f} and {values.max():.2f} rad/s: a steady "
        "turn is one and the same rate"
    )


@explains
def part_of_the_drive(drive: Drive) -> str:
    """Find a turn that ends before the drive, or begins after it has begun."""
    values = np.abs(turning(drive)) > 0.01
    if len(values) < 6 or not values.any() or values.all() or not drive.moving.any() or varies(drive):
        return ""
    times = drive.times[drive.moving]
    if np.count_nonzero(values[1:] != values[:-1]) != 1 or (np.abs(drive.linear[-1, 0]) > 0.01 and values[0]):
        return ""
    change = float(times[np.flatnonzero(values[1:] != values[:-1])[0] + 1])
    when = (
        f"from {change:.2f} s on, while the robot still drives"
        if values[0]
        else f"until {change:.2f} s, while it drives"
    )
    return f"angular.z is 0 {when}: the robot turns for a part of the drive only"


@explains
def an_angle_each_second(drive: Drive) -> str:
    strong = _strength(drive)
    name = next((name for value, name in ANGLES.items() if strong > SLIGHT and _near(strong, value)), "")
    if not name:
        return ""
    return f"angular.z was {strong:.2f} rad/s: {name} degrees in every second, where a slight turn is about 0.1 rad/s"


@explains
def wide_turn(drive: Drive) -> str:
    strong = _strength(drive)
    if not SLIGHT < strong <= DEGREES or _near(strong, drive.speed) or an_angle_each_second(drive):
        return ""
    if grows(drive) or varies(drive):
        return ""
    if strong <= STRONG:
        return f"angular.z was {strong:.2f} rad/s, which is no slight turn: 0.1 rad/s is one"
    return (
        f"angular.z was {strong:.2f} rad/s, which are {math.degrees(strong):.0f} degrees in every second and no slight "
        "turn: 0.1 rad/s is one"
    )


@explains
def weak_turn(drive: Drive) -> str:
    values = np.abs(drive.angular[drive.moving, 2])
    if not len(values) or not 0 < float(np.max(values)) < 0.02:
        return ""
    strong = float(np.max(values))
    twice = math.degrees(strong)
    reason = f"; {twice:.2g} in math.radians() would give that: the value was in rad/s already" if twice < 0.35 else ""
    return f"angular.z was at most {strong:.3g} rad/s: that is too weak for a turn{reason}"


@explains
def turn_in_degrees(drive: Drive) -> str:
    strong = _strength(drive)
    if strong <= DEGREES or _near(strong, drive.speed) or an_angle_each_second(drive) or grows(drive):
        return ""
    return (
        f"angular.z was {strong:.2f} rad/s, which looks like degrees per second: it is in radians per second, and "
        "math.radians() converts them"
    )


@explains
def wiggles(drive: Drive) -> str:
    values = drive.angular[np.abs(drive.angular[:, 2]) > 0.01, 2]
    if len(values) < 6 or not (values > 0).any() or not (values < 0).any():
        return ""
    changes = int(np.count_nonzero(np.diff(np.sign(values))))
    how = (
        "from command to command"
        if changes > 0.8 * (len(values) - 1)
        else "once"
        if changes == 1
        else f"{changes} times"
    )
    return f"the sign of angular.z changes {how}: the robot turns to the left and to the right alternately"


@explains
def to_the_right(drive: Drive) -> str:
    values = drive.angular[np.abs(drive.angular[:, 2]) > 0.01, 2]
    if len(values) and np.all(values < 0):
        return f"angular.z was {np.median(values):.2f} rad/s: a negative angular.z turns to the right"
    return ""


@explains
def no_turn(drive: Drive) -> str:
    if not drive.moving.any() or np.abs(drive.angular).max() > 1e-9:
        return ""
    sideways = drive.linear[np.abs(drive.linear[:, 1]) > 0.01, 1]
    if len(sideways):
        return (
            f"linear.y was {np.median(sideways):.2f} and angular.z 0: linear.y is a speed sideways, which wheels "
            "ignore; the turn is angular.z"
        )
    if np.abs(drive.linear[:, 1:]).any():
        return ""
    return "angular.z was 0 in every command: the robot drives straight"
