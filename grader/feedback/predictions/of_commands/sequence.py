"""Wrong sequences: one command only, no stop, commands that alternate, ramp or begin again."""

from __future__ import annotations

import numpy as np

from gz_course.grader.feedback.predictions.commands import Drive, explains
from gz_course.grader.feedback.predictions.of_commands.velocity import world_axes


@explains
def only_one(drive: Drive) -> str:
    if len(drive.times) != 1 or not drive.moving[0]:
        return ""
    return (
        f"one command only arrived, at {drive.times[0]:.2f} s, and nothing after it: the robot obeys it to the end, so "
        "a command of zeros must follow"
    )


@explains
def all_at_once(drive: Drive) -> str:
    together = int(np.sum(drive.times - drive.times[0] < 1e-3))
    if together < 4 or together < 0.5 * np.count_nonzero(drive.moving):  # a callback of messages that come in bundles
        return ""
    return (
        f"{together} commands came at the same moment, {drive.times[0]:.2f} s: a loop in one callback publishes them, "
        "while no time passes; send one in each call of the timer"
    )


@explains
def in_separate_messages(drive: Drive) -> str:
    """Find drives and turns that alternate from command to command."""
    turning = np.abs(drive.angular[:, 2]) > 0.01
    if not drive.moving.any() or not turning.any() or (drive.moving & turning).any():
        return ""
    busy = drive.moving[drive.moving | turning]
    if len(busy) < 6 or np.count_nonzero(busy[1:] != busy[:-1]) < 0.6 * (len(busy) - 1):
        return ""
    return (
        "every other command has linear.x only, and those between have angular.z only: each Twist takes the place of "
        "the one before, so both values belong in the same one"
    )


@explains
def one_after_the_other(drive: Drive) -> str:
    """Find a turn without a drive, before or after a drive without a turn."""
    turning = np.abs(drive.angular[:, 2]) > 0.01
    if not drive.moving.any() or not turning.any() or (drive.moving & turning).any() or in_separate_messages(drive):
        return ""
    first, second = ("turns", "drives") if np.argmax(turning) < np.argmax(drive.moving) else ("drives", "turns")
    return (
        f"your node first {first} and then {second}: linear.x and angular.z belong in the same command, so that the "
        "robot does both at once"
    )


@explains
def backwards_for_a_stop(drive: Drive) -> str:
    values = drive.linear[:, 0]
    last = values[-1]
    if last >= -0.01 or values.max() <= 0.01:
        return ""
    begin = drive.times[np.flatnonzero(values > 0.01)[-1] + 1]
    return (
        f"from {begin:.2f} s on linear.x is {last:.2f} m/s: a negative linear.x does not brake, it drives the robot "
        "backwards; 0 stops it"
    )


@explains
def no_stop(drive: Drive) -> str:
    """Find a drive that ceased without a stop."""
    if len(drive.times) < 2 or all_at_once(drive) or not drive.moving[-1] or drive.ended - drive.times[-1] < 0.8:
        return ""
    if len(drive.pushes) > 1 and "again" in drive.suspects:
        return ""  # `begins_again` says it
    return (
        f"the last command came at {drive.times[-1]:.2f} s and drives on: your node falls silent, where a command "
        "of zeros is needed"
    )


@explains
def slower_instead_of_a_stop(drive: Drive) -> str:
    """Find a steady drive that goes on, more slowly, to the end."""
    values = drive.linear[:, 0]
    last, first = values[-1], values[np.flatnonzero(drive.moving)[0]] if drive.moving.any() else 0.0
    if len(values) < 6 or not 0.01 < last < 0.9 * first:
        return ""
    changed = np.flatnonzero(np.abs(values - last) > 1e-6)[-1] + 1
    if np.ptp(values[:changed]) > 0.1 * first or len(values) - changed < 3:
        return ""
    return (
        f"from {drive.times[changed]:.2f} s on linear.x is {last:.2g} m/s, which is slower and no stop: the robot "
        "stands only if it is 0"
    )


@explains
def drives_on_straight(drive: Drive) -> str:
    """Find a turn that was ended while the drive was not."""
    turning = np.flatnonzero(np.abs(drive.angular[:, 2]) > 0.01)
    if not drive.moving.all() or not len(turning) or len(drive.times) - turning[-1] < 4:
        return ""
    return (
        f"from {drive.times[turning[-1] + 1]:.2f} s on angular.z is 0, but linear.x stays at "
        f"{drive.linear[-1, 0]:.2f} m/s: both must be 0 for a stop"
    )


@explains
def never_ends(drive: Drive) -> str:
    """Find a drive that went on to the end of the run."""
    pushes = drive.pushes
    if drives_on_straight(drive):
        return ""
    if len(drive.times) < 4 or len(pushes) != 1 or np.isfinite(pushes[0][1]) or drive.ended - drive.times[-1] >= 0.8:
        return ""
    if np.ptp(drive.linear[drive.moving, 0]) > 0.1 * abs(drive.steady):
        return ""
    turning = np.abs(drive.angular[:, 2]) > 0.01
    if turning.any() and not turning[-1] and len(turning) - np.flatnonzero(turning)[-1] > 3:
        return ""  # `drives_on_straight` says it
    if why := next(filter(None, map(drive.suspects.get, ("endless", "by_place", "hidden"))), ""):
        return f"{len(drive.times)} commands in a row drive the robot and not one stops it: {why}"
    decides = f"{drive.suspects['decides']} decides that, and it never changes; " if "decides" in drive.suspects else ""
    return (
        f"{len(drive.times)} commands in a row drive the robot and not one stops it: {decides}what your node compares "
        f"does not reach its limit in {drive.ended:.0f} s (a count of ticks, nanoseconds without the seconds, a start "
        f"that is set again in every callback, {drive.seconds:g} m where {drive.seconds:g} s are asked for), or it "
        "never compares"
    )


@explains
def alternates(drive: Drive) -> str:
    moving = drive.moving
    if len(drive.pushes) < 4:
        return ""
    first, last = np.flatnonzero(moving)[[0, -1]]
    changes = np.mean(moving[first + 1 : last + 1] != moving[first:last])
    values = sorted({round(float(v), 2) for v in drive.linear[first : last + 1, 0]})
    if changes < 0.6 or in_separate_messages(drive):
        return ""
    return (
        f"linear.x alternates between {values[0]:.2f} and {values[-1]:.2f}: two parts of your node (two timers, or two "
        "publish() calls in one callback) command the robot in turn"
    )


@explains
def begins_again(drive: Drive) -> str:
    if len(drive.pushes) < 2 or alternates(drive) or in_separate_messages(drive):
        return ""
    _, end, number = drive.pushes[0]
    again = drive.pushes[1][0]
    if why := drive.suspects.get("again"):
        return f"a command of zeros comes at {end:.2f} s, and at {again:.2f} s the robot is driven again: {why}"
    stops = int(np.sum(~drive.moving & (drive.times >= end) & (drive.times < again)))
    if stops <= 2 and number > 3:
        return (
            f"{'one command of zeros comes' if stops == 1 else 'two commands of zeros come'} at {end:.2f} s, and at "
            f"{again:.2f} s the next command drives the robot again: what sends the drive goes on after the stop; "
            "cancel its timer, or let it ask whether the time is over"
        )
    return f"the robot was driven {len(drive.pushes)} times: stopped at {end:.2f} s, driven again at {again:.2f} s"


@explains
def in_steps(drive: Drive) -> str:
    """Find a drive of two or three speeds, each for a while."""
    values = drive.linear[drive.moving, 0]
    if len(values) < 6 or np.ptp(values) < 0.1 * np.abs(values).max() or slower_instead_of_a_stop(drive):
        return ""
    changes = np.flatnonzero(np.abs(np.diff(values)) > 1e-6)
    if not 1 <= len(changes) <= 2 or np.any(values < 0):
        return ""
    when = drive.times[drive.moving][changes[0] + 1]
    return (
        f"linear.x is {values[0]:.2f} m/s at first and {values[changes[0] + 1]:.2f} m/s from {when:.2f} s on: it is to "
        f"be {drive.speed:g} m/s for the whole {drive.seconds:g} s"
    )


@explains
def ramps(drive: Drive) -> str:
    values = drive.linear[drive.moving, 0]
    if len(values) < 5 or np.ptp(values) < 0.2 * np.abs(values).max() or world_axes(drive):
        return ""
    steps = np.diff(values)
    growing, falling = np.mean(steps > 1e-4), np.mean(steps < -1e-4)
    if said := _gentle(drive, values, steps):
        return said
    if growing < 0.4 and falling < 0.4:
        return ""
    if growing and falling and min(growing, falling) > 0.3:
        return f"linear.x changes from command to command, from {values.min():.2f} to {values.max():.2f} m/s"
    way = "grows" if growing > falling else "falls"
    return (
        f"linear.x {way} from {values[0]:.2f} to {values[-1]:.2f} m/s, a ramp: {drive.speed:g} m/s is asked for from "
        "the first command on"
    )


def _gentle(drive: Drive, values: np.ndarray, steps: np.ndarray) -> str:
    """Return that a speed which is held meanwhile grows at first, and falls before the stop; empty if it does not."""
    up, down = np.flatnonzero(steps > 1e-4), np.flatnonzero(steps < -1e-4)
    held = np.mean(np.abs(values - values.max()) < 0.05 * abs(values.max()))
    if min(len(up), len(down)) < 2 or up[-1] > down[0] or held < 0.2:
        return ""
    times = drive.times[drive.moving]
    return (
        f"linear.x grows from {values[0]:.2f} to {values.max():.2f} m/s until {times[up[-1] + 1]:.2f} s and falls "
        f"again from {times[down[0]]:.2f} s on, ramps at both ends: {drive.speed:g} m/s is asked for from the first "
        "command to the last"
    )


@explains
def still_turning(drive: Drive) -> str:
    if drive.moving[-1] or abs(drive.angular[-1, 2]) <= 0.01 or not drive.moving.any():
        return ""
    return f"the last command stops linear.x, but angular.z stays at {drive.angular[-1, 2]:.2f} rad/s"
