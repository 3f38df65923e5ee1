"""Wrong speeds: units, signs, fields, factors, frames."""

from __future__ import annotations

import numpy as np

from gz_course.grader.feedback.predictions.commands import Drive, explains

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
    0.2: "that is a fifth of the speed asked for, as if it were divided by the five seconds",
    5.0: "that is five times the speed asked for, as if it were multiplied by the five seconds",
    0.277778: "that is the speed divided by 3.6, as if it were given in km/h",
    0.01: "that is a hundredth of the speed asked for, as if it were in cm/s",
    0.001: "that is a thousandth of the speed asked for, as if it were in mm/s",
}


@explains
def world_axes(drive: Drive) -> str:
    """Find a speed that is split into x and y of the world: linear.y grows as linear.x falls."""
    x, y = drive.linear[drive.moving, 0], drive.linear[drive.moving, 1]
    if len(x) < 6 or np.abs(y).max() < 0.05 or np.ptp(np.hypot(x, y)) > 0.02 * np.hypot(x, y).max() or np.ptp(y) < 0.03:
        return ""
    return (
        f"linear.x and linear.y are the parts of {np.hypot(x, y)[0]:.2f} m/s along the axes of the world (v cos, v sin "
        "of the heading): a Twist is given in the robot's own frame, where forward is always linear.x"
    )


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
