"""How the nearest range is looked for, and what becomes of the commands on their way: `misconceptions.py` asks."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect

if TYPE_CHECKING:
    from .wall import Run

FEWEST = 50  # commands
NUMBER = re.compile(r"(\d+\.?\d*)(?: m)? are left out")


def searched(run: Run) -> str:
    """Find out, by the file, whether another range than the nearest of this scan counts."""
    return suspect(run.recording, "nearest range", "divided")


def left_out(run: Run) -> str:
    """Find out whether the wall was at distances that the node leaves out by the file."""
    seen = run.distance[(run.times > 0.5) & np.isfinite(run.distance)]
    for about, worst in (("left out nearer", seen.min(initial=9.0)), ("left out farther", -seen.max(initial=0.0))):
        said = suspect(run.recording, about)
        limit = NUMBER.search(said)
        metres = float(limit[1]) if limit else float(np.max(run.asked, initial=0.0))
        if said and worst < (metres if about.endswith("nearer") else -metres):
            return f"{said}; the nearest point of the wall was {abs(worst):.2f} m away in this run"
    return ""


def quarters(run: Run) -> str:
    """Find out whether a part of the rays that looks to one side is taken for the other, by the file."""
    first = run.recording.signal("topics/lidar/scan/angle_min").values
    return suspect(run.recording, f"part {run.side}") if len(first) and first[0] < -3.0 else ""


def halves(run: Run) -> str:
    """Find out whether each scan is answered by two commands, one that drives and one that turns."""
    ahead = run.recording.signal("topics/cmd_vel/linear/x")
    turns = run.recording.signal("topics/cmd_vel/angular/z").values
    if len(turns) != len(ahead.values) or len(turns) < FEWEST:
        return ""
    drives, rotates = np.abs(ahead.values) > 0.01, np.abs(turns) > 0.01
    if (drives & rotates).any() or min(drives.mean(), rotates.mean()) < 0.25:
        return ""
    pairs = (drives[:-1] & rotates[1:]) | (rotates[:-1] & drives[1:])
    if pairs.mean() < 0.6 or np.median(np.diff(ahead.times)) > 4e7:
        return ""
    return (
        "each scan is answered by two commands, one with linear.x alone and one with angular.z alone: a command "
        "replaces the one before it, and a field that is not set is 0; set both fields of one Twist and publish it once"
    )


def ramp(run: Run) -> str:
    """Find out whether angular.z changes by no more than a fixed step from command to command, and often by that."""
    signal = run.recording.signal("topics/cmd_vel/angular/z")
    steps = np.abs(np.diff(signal.values))
    if len(steps) < FEWEST or not 1e-4 < (most := float(steps.max())) < 0.12:
        return ""
    share = float((steps > most - 1e-4).mean())
    apart = float(np.median(np.diff(signal.times))) / 1e9
    if share < 0.25 or apart <= 0 or most / apart > 1.0:
        return ""
    return (
        f"angular.z never changes by more than {most:.2g} rad/s from one command to the next, and by just that in "
        f"{share:.0%} of them: it takes {1.5 / most * apart:.1f} s from 0 to 1.5 rad/s, so the robot turns too "
        "late, and swings; send the rate that the scan asks for"
    )


def turns_to_one_side(run: Run) -> str:
    """Find out whether a wall ahead makes the robot turn towards the side of its wall, always at the same rate."""
    signal = run.recording.signal("topics/cmd_vel/angular/z")
    ahead = np.interp(signal.times / 1e9, run.times, np.minimum(run.ahead, 9.0))
    found, counts = np.unique(np.round(signal.values[ahead < 1.5], 3), return_counts=True)
    if not counts.sum() or counts.max() < 15:
        return ""
    usual = float(found[counts.argmax()])
    there = ahead[np.abs(signal.values - usual) < 1e-3]
    nearest = float(np.percentile(there, 90))
    all_there = np.abs(signal.values[ahead < 0.9 * nearest] - usual) < 1e-3
    if run.sign * usual < 0.3 or nearest > 1.6 or abs(usual) > 1.45 or all_there.mean() < 0.5:
        return ""
    to = "left" if usual > 0 else "right"
    return (
        f"where a wall was less than {nearest:.1f} m ahead, angular.z was {usual:.2f} rad/s, a turn to the {to}, and "
        f"side is {run.side!r}: turn away from the side of the wall there, so the sign must change with side"
    )


def stuck(run: Run) -> str:
    """Find out whether angular.z no longer changes from some time on, until the end."""
    signal = run.recording.signal("topics/cmd_vel/angular/z")
    other = np.flatnonzero(np.abs(signal.values - signal.values[-1:]) > 1e-3)
    if len(signal.values) < FEWEST or not len(other) or abs(last := float(signal.values[-1])) < 0.1:
        return ""
    times, since = signal.times / 1e9, int(other[-1]) + 1
    if times[-1] - times[since] < 5.0 or abs(last) > 1.45:
        return ""
    why = suspect(run.recording, "flag for ever")
    return (
        f"from {times[since]:.1f} s to the end angular.z is {last:.2f} rad/s in every command, whatever the lidar sees"
        f"{': ' if why else ''}{why}"
    )


def exchanged(run: Run, point: np.ndarray, rates: np.ndarray, asked: np.ndarray, ahead: np.ndarray) -> str:
    """Find out whether linear.x follows the wall as angular.z should, and angular.z the speed limit.

    `ahead` is linear.x [m/s] in the commands of `rates`.
    """
    if len(ahead) < FEWEST or (ahead < -0.05).mean() < 0.05 or not np.abs(rates).max() <= run.limit + 1e-3:
        return ""
    if np.sign(rates[np.abs(rates) > 1e-3]).min(initial=1) != np.sign(rates[np.abs(rates) > 1e-3]).max(initial=1):
        return ""
    wanted = 4 * np.clip(point[:, 0] - asked, -0.35, 0.35) + 2 * (point[:, 1] - np.pi / 2)
    clear = (np.abs(wanted) > 0.3) & (np.abs(ahead) > 0.05)
    agree = np.sign(run.sign * ahead[clear]) == np.sign(wanted[clear])
    if clear.sum() < FEWEST / 2 or agree.mean() < 0.85:
        return ""
    return (
        f"linear.x and angular.z are exchanged: linear.x goes from {ahead.min():.2f} to {ahead.max():.2f}, and its "
        "sign is that of the turn that is needed, and angular.z never changes its sign"
    )
