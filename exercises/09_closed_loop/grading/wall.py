"""The checks of this exercise: how the robot drove along its wall, by the simulator's truth.

The walls are the boxes of the model `walls`. The distance to the wall is that of the nearest point of any wall on the
side that the robot is to follow. `misconceptions.py` says what a wrong run looks like.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.record.reading import Recording, Signal
from gz_course.grader.score.check import Finding
from gz_course.grader.score.true_pose import heading

from . import driving, misconceptions

SPACING = 0.04  # [m] between two points of a wall
BEHIND = 0.8 * np.pi  # [rad] bearing beyond which a point does not count as on the side
TOUCH = 0.004  # [m] between the robot and a wall
AT_ONCE = 0.4  # [s] in which a new parameter takes effect
APPROACHED = 5.0  # [s] in which the robot comes to its wall
WEAVES = 0.25  # [rad/s] turns of either side beyond it count as weaving
WIDE = 0.3  # [m] error up to which the robot makes progress along its wall
# [m] chassis and wheels: from x, to x, from y, to y
PARTS = ((-0.18, 0.12, -0.1, 0.1), (-0.05, 0.05, -0.14, 0.14))


class Run:
    """The run at the times [s] of the truth, shape (n,), as all checks see it."""

    def __init__(self, recording: Recording) -> None:
        truth = [recording.signal(f"truth/robot/{name}") for name in ("x", "y", "yaw", "linear_x", "angular_z")]
        self.recording = recording
        self.lag = 0  # scans between that which a command answers and the last one before it
        self.lag = 0  # scans between that which a command answers and the last one before it
        self.times = truth[0].times / 1e9
        self.x, self.y, self.yaw, self.speed, self.turning = (signal.values for signal in truth)
        self.step = np.diff(self.times, append=self.times[-1:])
        given = json.loads(recording.properties("run")["trial_parameters"])["parameters"]
        self.side, self.limit = given["side"], given["speed_limit"]
        self.limits = recording.signal("parameters/speed_limit")  # [m/s] from each time on
        self.sign = 1.0 if self.side == "left" else -1.0
        asked = recording.signal("parameters/distance")
        self.asked = asked.values
        self.changed = float(asked.times[-1]) / 1e9 if len(asked) > 1 else np.inf
        self.wanted = asked.values[np.searchsorted(asked.times / 1e9, self.times, side="right") - 1]
        walls = [_wall(recording, entity) for entity in recording.entities("world/walls", "Boxes3D")]
        ahead, left = self._seen(np.concatenate([_outline(*wall) for wall in walls]))
        ranges, bearings = np.hypot(ahead, left), np.arctan2(self.sign * left, ahead)
        self.distance = np.where((bearings >= 0) & (bearings <= BEHIND), ranges, np.inf).min(axis=1)
        self.other_side = np.where(bearings < 0, ranges, np.inf).min(axis=1)
        self.ahead = np.where(np.abs(bearings) < 0.4, ranges, np.inf).min(axis=1)
        self.touches = self._gap(walls) <= TOUCH
        self.error = self.distance - self.wanted  # [m] by which the robot is too far from its wall
        self.along = self.speed * self.step  # [m] driven forward in each step

    def _seen(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return how far ahead and to the left [m] points (m, 2) are at each time, both (n, m)."""
        east, north = points[:, 0] - self.x[:, None], points[:, 1] - self.y[:, None]
        c, s = np.cos(self.yaw)[:, None], np.sin(self.yaw)[:, None]
        return c * east + s * north, c * north - s * east

    def _gap(self, walls: list[tuple[np.ndarray, float, float, float]]) -> np.ndarray:
        """Return the distance [m] between the robot's outline and the nearest wall, (n,)."""
        ahead, left = self._seen(np.concatenate([_corners(*wall) for wall in walls]))
        gap = np.full(len(self.times), np.inf)
        for back, front, right, far_left in PARTS:
            gap = np.minimum(gap, _outside(ahead, left, back, front, right, far_left).min(axis=1))
            for px in (back, front):
                for py in (right, far_left):
                    wx = self.x + px * np.cos(self.yaw) - py * np.sin(self.yaw)
                    wy = self.y + px * np.sin(self.yaw) + py * np.cos(self.yaw)
                    for (cx, cy), yaw, length, width in walls:
                        along = (wx - cx) * np.cos(yaw) + (wy - cy) * np.sin(yaw)
                        across = (wy - cy) * np.cos(yaw) - (wx - cx) * np.sin(yaw)
                        gap = np.minimum(gap, _outside(along, across, -length, length, -width, width))
        return gap

    def allowed(self, times: np.ndarray) -> np.ndarray:
        """Return the speed limit [m/s] at some times [s]: while it changes, the larger of the two."""
        since, values = self.limits.times / 1e9, self.limits.values
        if not len(values):
            return np.full(len(times), self.limit)
        now, before = (np.maximum(np.searchsorted(since, times - ago, side="right") - 1, 0) for ago in (0, AT_ONCE))
        return np.maximum(values[now], values[before])

    def within(self, start: float, end: float, tolerance: float) -> tuple[float, float]:
        """Return which share of the way between two times [s] was driven within `tolerance` [m], and the way [m].

        Where the robot drives backwards or off its wall, the way counts as outside.
        """
        chosen = (self.times >= start) & (self.times <= end)
        way = np.abs(self.along[chosen]).sum()
        inside = (np.abs(self.error[chosen]) <= tolerance) & (self.speed[chosen] > 0)
        return (float(self.along[chosen][inside].sum() / way) if way > 0.0 else 0.0), float(way)


def _wall(recording: Recording, entity: str) -> tuple[np.ndarray, float, float, float]:
    """Return the centre [m], the direction [rad], half the length and half the width [m] of a wall."""
    link, shape = recording.poses(entity.rpartition("/")[0]), recording.static(entity)
    assert link is not None, entity
    assert link is not None, entity
    half_length, half_width, _ = shape["Boxes3D:half_sizes"]
    return (
        link.positions[0, :2],
        heading(link.quaternions[0]),
        half_length,
        half_width,
    )


def _outline(centre: np.ndarray, yaw: float, half_length: float, half_width: float) -> np.ndarray:
    """Return points on both long sides of a wall, (m, 2) [m]."""
    along = np.linspace(-half_length, half_length, 2 + round(2 * half_length / SPACING))
    direction, normal = np.array((np.cos(yaw), np.sin(yaw))), np.array((-np.sin(yaw), np.cos(yaw)))
    sides = [centre + np.outer(along, direction) + across * normal for across in (-half_width, half_width)]
    return np.concatenate(sides)


def _corners(centre: np.ndarray, yaw: float, half_length: float, half_width: float) -> np.ndarray:
    return _outline(centre, yaw, half_length, half_width)[[0, -1]]


def _outside(x: np.ndarray, y: np.ndarray, low_x: float, high_x: float, low_y: float, high_y: float) -> np.ndarray:
    """Return how far [m] points are outside of a rectangle."""
    return np.hypot(np.maximum(np.maximum(low_x - x, x - high_x), 0), np.maximum(np.maximum(low_y - y, y - high_y), 0))


def _finding(run: Run, passed: bool, expected: str, measured: str, at: float | None = None) -> Finding:
    """Return a finding; one that failed asks which misconception fits."""
    why = "" if passed else misconceptions.explain(run)
    return Finding(bool(passed), expected, measured, None if at is None else round(float(at), 2), explanation=why)


def keeps_distance(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Check the distance before the parameter changes, or after that (`changed = true`)."""
    run = Run(recording)
    tolerance, share, settle = parameters["tolerance"], parameters["share"], parameters["settle"]
    second = parameters.get("changed", False)
    if second and not np.isfinite(run.changed):  # the run ended early, or the parameter has not been declared
        return _finding(run, False, "the parameter distance is set while the node runs", "it was not set in this run")
    start, end = (run.changed + settle, run.times[-1]) if second else (settle, min(run.changed, run.times[-1]))
    wanted = run.asked[-1 if second else 0]
    where = f"{wanted:g} m ± {tolerance:g} m from the wall on the {run.side}"
    expected = f"{where} on {share:.0%} of the way, {start:g} to {end:g} s"
    refused = [each for each in recording.facts().get("parameters_set", []) if each["outcome"] != "set"]
    if second and refused:  # whatever its callback has stored, to everybody else the parameter is what it was
        return Finding(False, expected, "the new value of the parameter was refused", start)
    kept, way = run.within(start, end, tolerance)
    if way < parameters["way"]:
        return _finding(
            run,
            False,
            expected,
            f"the robot drove {way:.1f} m then, at least {parameters['way']:g} m are needed",
            start,
        )
    chosen = (run.times >= start) & (run.times <= end)
    usual = np.average(np.minimum(run.distance[chosen], 9.9), weights=np.abs(run.along[chosen]) + 1e-9)
    least = run.distance[chosen].min()
    measured = f"within the band on {kept:.0%} of the way; {usual:.2f} m on average, {least:.2f} m at least"
    passed = kept >= share
    off = chosen & (np.abs(run.error) > tolerance)
    return _finding(run, passed, expected, measured, None if passed else run.times[off][0] if off.any() else start)


def follows(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Check how far the robot drove forward with its wall beside it."""
    run = Run(recording)
    near = (np.abs(run.error) <= WIDE) & (run.speed > 0)
    way, could = float(run.along[near].sum()), float((run.allowed(run.times) * run.step).sum())
    least = parameters["share"] * could
    beside, _ = run.within(APPROACHED, run.times[-1], WIDE)
    if way < least and beside > 0.85 and (why := _slow(run)):
        said = f"{way:.1f} m; with speed_limit = {run.limit:g} m/s it could be {could:.1f} m"
        return Finding(False, f"at least {least:.1f} m forward along the wall on the {run.side}", said, explanation=why)
    return _finding(
        run,
        way >= least,
        f"at least {least:.1f} m forward along the wall on the {run.side}",
        f"{way:.1f} m; with speed_limit = {run.limit:g} m/s it could be {could:.1f} m",
    )


def _slow(run: Run) -> str:
    """Return why a robot that keeps its distance is slow; empty if it is not."""
    times = run.recording.arrays("topics/lidar/scan/ranges")[0] / 1e9
    return (
        suspect(run.recording, "divided")
        or driving.silent(run, times)
        or driving.backwards(run)
        or _late(run)
        or driving.slow(run)
    )


def _late(run: Run) -> str:
    """Return why a robot that weaves is slow, if its commands come late; empty if not."""
    if count_swings(run.turning, WEAVES) < max(6, np.abs(run.along).sum()):
        return ""
    why = suspect(run.recording, "delay") or misconceptions.late(run)
    return f"the robot weaves, which makes it slow: {why}" if why else ""


def touches_nothing(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Check that the robot never touches a wall."""
    run = Run(recording)
    at = run.times[run.touches][0] if run.touches.any() else None
    where = f"it touched a wall at {at:.1f} s" if at is not None else "it never did"
    return _finding(run, at is None, "the robot touches no wall", where, at)


def keeps_limits(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Check every command that arrived."""
    run, most = Run(recording), parameters["turning"]
    new = f", and {run.limits.values[-1]:g} m/s from {run.limits.times[-1] / 1e9:g} s on" if len(run.limits) > 1 else ""
    expected = f"linear.x from 0 to {run.limit:g} m/s (speed_limit{new}), angular.z from -{most:g} to {most:g} rad/s"
    for name, low, high, unit in (("linear/x", 0.0, run.limit, "m/s"), ("angular/z", -most, most, "rad/s")):
        signal = recording.signal(f"topics/cmd_vel/{name}")
        highest = run.allowed(signal.times / 1e9) if name == "linear/x" else high
        beyond = (signal.values > highest + 1e-3) | (signal.values < low - 1e-3)
        if beyond.any():
            wrong, at = signal.values[beyond], signal.times[beyond][0] / 1e9
            worst = wrong[np.argmax(np.abs(wrong))]
            said = (
                f"{name.replace('/', '.')} was beyond in {beyond.sum()} of {len(beyond)} commands, first at {at:.1f} s"
            )
            seen = f"{said}; the worst was {worst:.2f} {unit}"
            old = name == "linear/x" and not ((signal.values > high + 1e-3) | (signal.values < low - 1e-3)).any()
            if old:
                why = old_limit(run, signal, float(worst))
            else:
                why = too_fast(run, worst) if name == "linear/x" else suspect(recording, "limit")
            why = why or limits_missed(name.replace("/", "."), signal.values, low, high)
            return Finding(False, expected, seen, round(float(at), 2), explanation=why)
    return Finding(True, expected, "every command was")


def old_limit(run: Run, signal: Signal, worst: float) -> str:
    """Return why linear.x still goes up to `worst` [m/s] after speed_limit was set to less."""
    changed = run.limits.times[-1]
    before = signal.values[signal.times < changed]
    why = suspect(run.recording, "parameter speed_limit", "seldom speed_limit", "parameter", "speed limit")
    if not why and len(before) and worst > 0.95 * before.max():
        why = "the old limit still counts"
    return (
        f"speed_limit was set from {run.limit:g} to {run.limits.values[-1]:g} m/s at {changed / 1e9:g} s, and linear.x "
        f"still goes up to {worst:.2f} m/s: {why or 'the new limit is not that of all that is sent'}"
    )


def too_fast(run: Run, worst: float) -> str:
    """Return why linear.x goes up to `worst` [m/s]; empty if it is negative, or nothing is known."""
    said = suspect(run.recording, "parameter speed_limit")
    if worst < 0 or (why := driving.speed_by_distance(run)):
        return why if worst > 0 else ""
    why = suspect(run.recording, "speed limit") or (said if "nothing reads it" in said else "")
    why = why or "it does not limit what is sent in the end"
    return f"linear.x goes up to {worst:.2f} m/s, and speed_limit is {run.limit:g} m/s: {why}"


def limits_missed(name: str, values: np.ndarray, low: float, high: float) -> str:
    """Return what values look like that are beyond their limits."""
    if np.unique(np.round(values, 3)).size == 1:
        return f"{name} is always {values[0]:.2f}"
    if (values < low - 1e-3).all() or (values > high + 1e-3).all():
        return f"{name} is never within {low:g} and {high:g}: min and max are exchanged, or the limit is another one"
    if low == 0.0 and values.min() < -1e-3 and values.max() <= high + 1e-3:
        return f"{name} becomes negative, which drives backwards: a factor of it, such as 1 - |turning|, is below 0"
    worst = float(np.abs(values).max())
    if np.mean(np.abs(np.abs(values) - worst) < 1e-3) > 0.1:
        return f"{name} is limited to {worst:.2f}, but {high:g} is the limit"
    for bound, other, within in ((high, low, values.max() <= high + 1e-3), (low, high, values.min() >= low - 1e-3)):
        if low < 0 and within and (np.abs(values - bound) < 1e-3).sum() > 2:
            return f"{name} is limited at {bound:g}, but not at {other:g} on the other side"
    return f"{name} is not limited, or something is added to it after that"


def drives_steadily(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Check how often the robot changed from turning left to turning right or back."""
    run = Run(recording)
    swings, metres = count_swings(run.turning, parameters["turning"]), float(np.abs(run.along).sum())
    most = parameters["fewest"] + parameters["per_metre"] * metres
    expected = f"at most {most:.0f} changes between left and right turns faster than {parameters['turning']:g} rad/s"
    return _finding(run, swings <= most, expected, f"{swings} changes in {metres:.1f} m")


def count_swings(turning: np.ndarray, least: float) -> int:
    """Return how often a turning rate goes from beyond one of -least and least [rad/s] to beyond the other."""
    signs = np.sign(turning)[np.abs(turning) > least]
    return int(np.count_nonzero(np.diff(signs)))
