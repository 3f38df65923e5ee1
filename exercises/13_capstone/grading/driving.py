"""What is wrong with how a robot explored, or with what its map leaves out; `checks.py` asks for it."""

from __future__ import annotations

import re

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.floor import Shapes

from . import last_commands

AHEAD = 0.35  # [rad] to either side of the heading: what is touched there was driven at
MOVED = 0.3  # [m]
SLOW = 0.15  # [m/s]
TURNS = 4.0  # of the whole robot, that are more than a way needs
FITS = 0.8
PLANNING = (
    "sleep",
    "forgets",
    "pose",
    "counter",
    "sign",
    "cell",
    "way",
    "search",
    "straight",
    "standstill",
)  # suspects in how a way is found and followed


def commands(recording: Recording) -> tuple[np.ndarray, np.ndarray]:
    """Return the commanded speeds [m/s] and turning rates [rad/s]."""
    return recording.signal("topics/cmd_vel/linear/x").values, recording.signal("topics/cmd_vel/angular/z").values


def stands(recording: Recording) -> str:
    """Return why a robot never drove, as far as its commands and its file tell; empty if they do not."""
    ahead, turning = commands(recording)
    if not len(ahead):
        return "no command came on /cmd_vel"
    if said := suspect(recording, "forgets") or sideways(recording) or backwards(recording):
        return said
    tests = [f"line {each['line']}, `{each['code']}`" for each in recording.facts().get("before_speeds", [])]
    never = f"; one of the conditions before it never held: {'; '.join(tests[-2:])}" if tests else ""
    still = suspect(recording, "flag", "cell", "wide", "way")
    if not np.abs(ahead).max() > 0.01 and not np.abs(turning).max() > 0.01:
        return still or f"all of its {len(ahead)} commands were 0{never}"
    if not np.abs(ahead).max() > 0.01:
        said = suspect(recording, "sleep", "pose", "counter", "sign", "cell", "heading", "angle", "ray")
        return still or said or f"linear.x was 0 in every command{never}"
    return suspect(recording, "pose", "way")


def backwards(recording: Recording) -> str:
    """Return that the robot is commanded to drive backwards nearly always when it drives; empty if it is not."""
    ahead, _ = commands(recording)
    moving = ahead[np.abs(ahead) > 0.02]
    if len(moving) < 10 or np.mean(moving < 0) < 0.8:
        return ""
    return (
        f"linear.x is negative in {np.mean(moving < 0):.0%} of the commands that drive, such as {np.median(moving):.2f}"
        " m/s: the robot drives backwards, away from where it looks; positive is ahead"
    )


def sideways(recording: Recording) -> str:
    """Return that the robot is commanded to drive sideways; empty if it is not."""
    aside = recording.signal("topics/cmd_vel/linear/y").values
    _, turning = commands(recording)
    for axis in "xy":
        rolling = recording.signal(f"topics/cmd_vel/angular/{axis}").values
        if np.mean(np.abs(rolling) > 0.02) > 0.1 if len(rolling) else False:
            return f"angular.{axis} is up to {np.abs(rolling).max():.2f} rad/s: a robot on the floor turns by angular.z"
    if not len(aside) or np.mean(np.abs(aside) > 0.02) < 0.1:
        return ""
    never = " (angular.z is 0 in every command)" if not np.abs(turning).max() > 0.01 else ""
    return (
        f"linear.y is up to {np.abs(aside).max():.2f} m/s, but a robot on two wheels cannot drive sideways: linear.x "
        f"is straight ahead for the robot, whichever way it looks, and angular.z turns it{never}"
    )


def slow_or_lost(recording: Recording) -> str:
    """Return why a robot that drove did not see all rooms; empty if that is not known."""
    ahead, _ = commands(recording)
    yaw = recording.signal("truth/robot/yaw").values
    way = recording.signal("truth/robot/distance").values.max(initial=0.0)
    x, y = (recording.signal(f"truth/robot/{name}").values for name in "xy")
    seconds = recording.end_ns / 1e9
    turns = float(np.abs(np.diff(yaw)).sum()) / (2 * np.pi)
    if (
        aside := sideways(recording)
        or backwards(recording)
        or suspect(recording, "sleep")
        or last_commands.kept(recording)
    ):
        return aside
    planning = suspect(recording, *PLANNING) or suspect(recording, "heading", "angle") or suspect(recording, "wide")
    if turns > TURNS and way < 0.1 * seconds:
        said = planning or suspect(recording, "heading", "angle", "ray", "wrap") or how_it_turned(recording)
        return f"the robot turned around {turns:.0f} times and drove {way:.1f} m: {said}"
    if len(ahead) and 0 < ahead.max() < SLOW:
        return f"linear.x was {ahead.max():.2f} m/s at most, too slow to see all rooms in {seconds:.0f} s"
    if way < 0.1 * seconds:
        return f"the robot drove {way:.1f} m in {seconds:.0f} s: {planning or what_it_did(recording)}"
    if planning or suspect(recording, "wrap"):
        return planning or suspect(recording, "wrap")
    _, turning = commands(recording)
    for side, most in (("left", -turning.min(initial=0.0)), ("right", turning.max(initial=0.0))):
        if most < 0.01 < np.abs(turning).mean() and turns > 2:
            return (
                f"angular.z never has the other sign: the robot turned to the {side} only, the long way round to all "
                "that is on its other side: turn to the side on which the goal is"
            )
    if np.abs(yaw[-1] - yaw[0]) / (2 * np.pi) > TURNS:
        return f"the robot drove in circles, {abs(yaw[-1] - yaw[0]) / (2 * np.pi):.0f} times around to the same side"
    if max(np.ptp(x), np.ptp(y)) < 0.25 * way:
        return f"the robot drove {way:.0f} m, but within {np.ptp(x):.1f} by {np.ptp(y):.1f} m, to and fro"
    return ""


def standing(recording: Recording) -> str:
    """Return since when the robot stands, or turns on the spot; empty if it drove until near the end."""
    way = recording.signal("truth/robot/distance")
    last = float(way.times[np.argmax(way.values >= way.values[-1] - MOVED)] / 1e9)
    if last > 0.7 * recording.end_ns / 1e9:
        return ""
    return f"the robot stayed where it was from {last:.0f} s on, and parts of the rooms were not seen"


def how_it_turned(recording: Recording) -> str:
    """Return what a robot that turned more than it drove did, as it is seen from outside."""
    yaw = np.unwrap(recording.signal("truth/robot/yaw").values)
    net, whole = abs(yaw[-1] - yaw[0]), float(np.abs(np.diff(yaw)).sum())
    if net > 0.8 * whole:
        return f"it turned to the {'left' if yaw[-1] > yaw[0] else 'right'} nearly all the time"
    _, turning = commands(recording)
    signs = np.sign(turning[np.abs(turning) > 0.05])
    times = int(np.sum(signs[1:] != signs[:-1]))
    if times > 5:
        return f"it swung to and fro, and the sign of angular.z changed {times} times"
    return "it turned to and fro"


def what_it_did(recording: Recording) -> str:
    """Return what a robot that drove little was commanded to do."""
    ahead, turning = commands(recording)
    if not len(ahead) or len(ahead) != len(turning):
        return "most of the time it stood or turned"
    times = recording.signal("topics/cmd_vel/linear/x").times / 1e9
    moves = np.flatnonzero((np.abs(ahead) > 0.01) | (np.abs(turning) > 0.01))
    last = float(times[moves[-1]]) if len(moves) else 0.0
    if last < 0.8 * times[-1]:
        why = suspect(recording, "ray") or "as if nothing were left to explore, or no way were found"
        return f"all commands from {last:.0f} s on are 0; {why}"
    if np.mean((np.abs(ahead) < 0.01) & (np.abs(turning) > 0.05)) > 0.5:
        return how_it_turned(recording)
    return "most of the time it stood or turned"


def in_the_map(said: np.ndarray, point: np.ndarray, at: float) -> str:
    """Return whether a map that came at a time [s] shows what was touched at a point [m]; None if it shows nothing."""
    column, row = (int((point[i] + corner) / 0.1) for i, corner in ((0, 5.0), (1, 4.0)))
    around = said[max(row - 2, 0) : row + 3, max(column - 2, 0) : column + 3]
    if not around.size:
        return ""
    if (around >= 65).any():
        return f"your map of {at:.1f} s shows it there"
    shown = "free" if ((around >= 0) & (around <= 25)).sum() > (around < 0).sum() else "unknown"
    return f"your map of {at:.1f} s does not show it: the cells there are {shown}"


def touched(recording: Recording, radius: float, at: int, place: np.ndarray, there: str = "") -> str:
    """Return how the robot came to touch something at a time [ns], whose nearest point is at `place` (x, y) [m].

    `there` says whether the map showed it.
    """
    x, y, yaw = (
        float(np.interp(at, signal.times, signal.values))
        for signal in (recording.signal(f"truth/robot/{name}") for name in ("x", "y", "yaw"))
    )
    bearing = np.remainder(np.arctan2(place[1] - y, place[0] - x) - yaw + np.pi, 2 * np.pi) - np.pi
    kinds = "sleep", "forgets", "pose", "counter", "sign", "cell", "way", "search", "part", "ray", "heading", "angle"
    if said := suspect(recording, *kinds, "straight"):
        return said
    if said := last_commands.kept(recording, at / 1e9) or sideways(recording) or backwards(recording):
        return said
    if said := drives_while_turning(recording):
        return said
    if said := without_a_way(recording, at) or suspect(recording, "left_out_walls", "far_aim"):
        return said
    if abs(bearing) > AHEAD and (said := suspect(recording, "narrow")):
        return said
    if "does not show it" in there:
        return f"{there}, so no way keeps away from it: see that hits stay in the map that it drives by"
    more = f"; {there}" if there else ""
    if abs(bearing) > AHEAD:
        side = "left" if bearing > 0 else "right"
        return (
            f"it touched it with its {side} side, {abs(np.degrees(bearing)):.0f} degrees from ahead{more}: its way "
            f"leaves less room than the robot's radius, {radius:g} m, or it does not keep to the cells of its way"
        )
    return f"it drove straight at it: nothing that the scanner sees ahead stops or turns the robot in time{more}"


def without_a_way(recording: Recording, at: float) -> str:
    """Return that a robot drove ahead where it had no way, if its command at a time [ns] was that one."""
    said, signal = suspect(recording, "blind"), recording.signal("topics/cmd_vel/linear/x")
    speed, before = re.search(r"linear\.x is ([\d.]+)", said), signal.values[signal.times <= at][-5:]
    return said if speed and len(before) and np.any(np.abs(before - float(speed[1])) < 1e-3) else ""


def drives_while_turning(recording: Recording) -> str:
    """Return that the robot never slows down where it turns hard; empty if it does."""
    ahead, turning = commands(recording)
    if len(ahead) != len(turning) or not len(ahead) or np.abs(turning).max() < 0.9:
        return ""
    hard = np.abs(turning) > 0.8 * np.abs(turning).max()
    if hard.sum() < 10 or np.mean(ahead[hard] > 0.9 * ahead.max()) < 0.9:
        return ""
    return (
        f"it drives on with {ahead.max():.2f} m/s, as fast as ever, while it turns with {np.abs(turning).max():.1f} "
        "rad/s, and leaves its way in wide curves: drive slowly, or not at all, until it looks along the way"
    )


def nearest_point(shapes: Shapes, point: tuple[float, float]) -> np.ndarray:
    """Return the point of an obstacle that is nearest to one [m], found on rings around it."""
    for distance in np.arange(0.0, 0.5, 0.01):
        angles = np.linspace(-np.pi, np.pi, 73)
        ring = np.stack([point[0] + distance * np.cos(angles), point[1] + distance * np.sin(angles)], 1)
        off = shapes.nearest(ring)
        if off.min() < 0.012:
            return ring[int(off.argmin())]
    return np.asarray(point)
