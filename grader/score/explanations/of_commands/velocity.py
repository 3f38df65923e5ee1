"""Wrong velocities: units, signs, fields, factors."""

from __future__ import annotations

import numpy as np

from gz_course.grader.score.explanations.commands import Drive, explains

# Factor between what was sent and what was asked for -> its reason.
SPEEDS = {
    3.6: "that is the speed in km/h",
    100.0: "that is the speed in cm/s",
    1000.0: "that is the speed in mm/s",
    2.23694: "that is the speed in miles per hour",
    2.0: "that is twice the speed asked for",
    0.5: "that is half the speed asked for",
    10.0: "that is ten times the speed asked for",
    0.1: "that is a tenth of the speed asked for",
    0.2: "that is the distance driven, divided by more than the time, or a fifth of the speed asked for",
}
SLIGHT = 0.33  # [rad/s] a turn up to this is slight
STRONG = 0.8  # [rad/s] more looks like degrees


def _near(value: float, wanted: float) -> bool:
    return abs(value - wanted) <= 0.02 * abs(wanted) + 1e-6


@explains
def nothing_but_zeros(drive: Drive) -> str:
    if drive.linear.any() or drive.angular.any():
        return ""
    number = f"all {len(drive.times)} commands" if len(drive.times) > 1 else "the only command"
    return f"{number} were zero in every field" if len(drive.times) > 1 else f"{number} was zero in every field"


@explains
def swapped(drive: Drive) -> str:
    turning = drive.angular[np.abs(drive.angular[:, 2]) > 0.01, 2]
    if not len(turning) or not _near(float(np.median(turning)), drive.speed) or _near(drive.steady, drive.speed):
        return ""
    return (
        f"linear.x and angular.z are swapped: angular.z was {np.median(turning):.2f} rad/s, linear.x "
        f"{drive.steady:.2f} m/s"
    )


@explains
def other_field(drive: Drive) -> str:
    said = []
    for of, values, right in (("linear", drive.linear, 0), ("angular", drive.angular, 2)):
        if np.abs(values[:, right]).max() > 0.01:
            continue
        said += [
            f"{of}.{axis} was set to {values[np.abs(values[:, i]) > 0.01, i][0]:.2f}, but the robot takes its command "
            f"from {of}.{'xyz'[right]}"
            for i, axis in enumerate("xyz")
            if i != right and np.abs(values[:, i]).max() > 0.01
        ]
    return said[0] if said else ""


@explains
def backwards(drive: Drive) -> str:
    if drive.steady < -0.01 and np.all(drive.linear[:, 0] <= 0.01):
        return f"linear.x was {drive.steady:.2f} m/s: a negative linear.x drives backwards"
    return ""


@explains
def to_the_right(drive: Drive) -> str:
    turning = drive.angular[np.abs(drive.angular[:, 2]) > 0.01, 2]
    if len(turning) and np.all(turning < 0):
        return f"angular.z was {np.median(turning):.2f} rad/s: a negative angular.z turns to the right"
    return ""


@explains
def no_turn(drive: Drive) -> str:
    if drive.moving.any() and not drive.angular.any() and not np.abs(drive.linear[:, 1:]).any():
        return "angular.z was 0 in every command: the robot drives straight"
    return ""


@explains
def other_speed(drive: Drive) -> str:
    values = np.abs(drive.linear[drive.moving, 0])
    if not len(values) or np.ptp(values) > 0.02 * values.max():
        return ""
    for factor, reason in SPEEDS.items():
        if _near(float(values[0]), factor * drive.speed):
            return f"linear.x was {values[0]:.2f} m/s where {drive.speed:g} m/s is asked for: {reason}"
    if abs(values[0] - drive.speed) > 0.1 * drive.speed:
        return f"linear.x was {values[0]:.2f} m/s where {drive.speed:g} m/s is asked for"
    return ""


@explains
def wiggles(drive: Drive) -> str:
    turning = drive.angular[np.abs(drive.angular[:, 2]) > 0.01, 2]
    if len(turning) < 6 or not (turning > 0).any() or not (turning < 0).any():
        return ""
    changes = int(np.count_nonzero(np.diff(np.sign(turning))))
    how = "from command to command" if changes > 0.8 * (len(turning) - 1) else f"{changes} times"
    return f"the sign of angular.z changes {how}: the robot turns to the left and to the right by turns"


@explains
def wide_turn(drive: Drive) -> str:
    turning = drive.angular[drive.moving, 2] if drive.moving.any() else drive.angular[:, 2]
    strong = float(np.median(np.abs(turning))) if len(turning) else 0.0
    if not SLIGHT < strong <= STRONG or _near(strong, drive.speed):
        return ""
    return f"angular.z was {strong:.2f} rad/s, which is no slight turn: 0.1 rad/s is one"


@explains
def weak_turn(drive: Drive) -> str:
    turning = np.abs(drive.angular[drive.moving, 2])
    if not len(turning) or not 0 < float(np.max(turning)) < 0.02:
        return ""
    return f"angular.z was at most {np.max(turning):.3g} rad/s: so weak a turn is hardly one"


@explains
def turn_in_degrees(drive: Drive) -> str:
    turning = drive.angular[drive.moving, 2] if drive.moving.any() else drive.angular[:, 2]
    strong = float(np.median(np.abs(turning))) if len(turning) else 0.0
    if strong <= STRONG or _near(strong, drive.speed):
        return ""
    return f"angular.z was {strong:.2f} rad/s, which looks like degrees per second: math.radians() converts them"
