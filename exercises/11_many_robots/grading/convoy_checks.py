"""Checks that only this exercise needs: a row of robots, their names in ROS, and the gaps between them."""

from __future__ import annotations

import itertools
import math
import re
from typing import Any

import numpy as np

from gz_course.grader.feedback.errors.launch_errors import launch_meaning
from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.grader.score.graphs import bridges
from gz_course.grader.score.launched import complaint, deaths, declared, logged_error

from . import convoy_rows, follower_ends, follower_fits, follower_lags, follower_origins, follower_turns
from .convoy import DRIVES, asked_for, robots_there
from .convoy_rows import GAP, ROW

ASIDE = 0.2  # [rad] that a robot may be turned at its start
NEAREST, FARTHEST = 0.75, 1.75  # [m] between two robots at any time
STEPS = 4  # speeds of a follower that sends nothing in between
AT_REST = 0.3  # [m] that the gap may be off in the end
NO_MODEL = re.compile(r"model '([^'/]+\.(?:sdf|urdf))' was not found")
STARTED = re.compile(r"^\[INFO\] \[create-\d+\]: process started")
HEADING = "its own heading"  # words of an explanation that a line of the file may say better


def _create_said(recording: Recording) -> str:
    """Return the first error of a create; empty if all went well."""
    died = next((death.said for death in deaths(recording) if death.process == "create"), "")
    return logged_error(recording, "create") or complaint(recording, "create") or died


def in_a_row(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if exactly the robots that were asked for are there, each in its place."""
    names, called = asked_for(recording)
    expected = f"{called}: {', '.join(names)} in a row, {GAP} m apart"
    there = robots_there(recording)
    if not there:
        said = _create_said(recording)
        why = launch_meaning(said) if said else "create of ros_gz_sim puts a model into a running world"
        if match := NO_MODEL.search(said):
            why = (
                f"{match[1]} is looked for in the folder in which ros2 launch is called, and not beside the launch "
                f"file: give its full path, str(Path(__file__).parent / '{match[1]}')"
            )
        if any("waits here" in each["said"] for each in recording.facts().get("launch_slips", [])):
            return Finding(False, expected, "no robot came into the world")
        if not said and not any(STARTED.match(line.text) for line in recording.lines("log/student")):
            why = (
                "no create was ever started: an action runs only if it is in the LaunchDescription, or in the list "
                "that a function of OpaqueFunction returns"
            )
        measured = f"no robot came into the world{': ' if said else ''}{said}"
        return Finding(False, expected, measured, explanation=why, nothing=True)
    if there != sorted(names):
        why = ""
        failed = _create_said(recording)
        numbers = [name.removeprefix("robot") for name in there]
        if there == names[:-1] and not failed:
            why = (
                f"{names[-1]} is missing: range(1, n) ends before n, or the argument robots has no effect: "
                f"{len(names)} robots were asked for"
            )
        elif len(there) < len(names) and there == names[: len(there)]:
            times = sum(bool(STARTED.match(line.text)) for line in recording.lines("log/student"))
            why = (
                f"the argument robots has no effect, or a loop ends too early: create was started {times} times, and "
                f"{len(names)} robots were asked for"
            )
            why = f"a create failed: {failed}" if failed else why
            if "already has something called" in failed:
                why = f"each create needs a name of its own, -name {names[len(there)]} and so on: {failed}"
        elif len(there) < len(names) and failed:
            why = f"a create failed: {failed}"
        elif len(there) == len(names) and numbers == [str(number) for number in range(len(there))]:
            why = "range(n) begins with 0, and the first robot is robot1: range(1, n + 1)"
        elif len(there) == len(names):
            others = ", ".join(name for name in there if name not in names)
            why = (
                f"create gives the name with -name: {others} should be {', '.join(n for n in names if n not in there)}"
            )
        elif len(there) > len(names):
            why = f"the argument robots has no effect: {len(names)} robots were asked for"
        if there == names[: len(there)] and not failed:
            why = convoy_rows.ends_there(recording, len(there), called) or why
        why = declared(recording, "robots", "2") or why
        return Finding(False, expected, f"{called}, there were {', '.join(there)}", explanation=why)
    for number, name in enumerate(names):
        x, y = (recording.signal(f"truth/{name}/{axis}").values[0] for axis in ("x", "y"))
        if math.hypot(x + GAP * number, y) > ROW:
            measured = f"{name} began at x {x:.2f} m, y {y:.2f} m, not at x {-GAP * number:.2f} m"
            return Finding(False, expected, measured, explanation=convoy_rows.misplaced(recording, names))
        yaw = float(recording.signal(f"truth/{name}/yaw").values[0])
        if abs(math.remainder(yaw, math.tau)) > ASIDE:
            why = "-R, -P and -Y of create turn a robot [rad]; without them it looks along x"
            measured = f"{name} began with a heading of {yaw:.2f} rad, and does not look along x"
            return Finding(False, expected, measured, explanation=why)
    return Finding(True, expected, f"{called}, so it was")


def _stopped(recording: Recording, sent: list[follower_fits.Heard]) -> str:
    return suspect(recording, "stopped") if sent and follower_lags.stopped(sent) else ""


def _late(recording: Recording, name: str, front: str) -> str:
    return follower_lags.late(recording, name, front, follower_fits.heard, follower_fits.line)


def _reason(sent: list[follower_fits.Heard]) -> str:
    """Return the misconception that fits the commands of a follower; empty if none does."""
    if said := follower_fits.seen_elsewhere(sent):
        return said
    speed = follower_fits.speed(sent)
    turning = "" if speed else follower_turns.turning(sent)  # a wrong place makes both wrong
    turns = f"it turns another way than to the place of the robot in front: {turning}" if turning else ""
    return speed or turns


def keeps_together(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if the first robot drives, and each other one is behind the one in front all the time."""
    names, called = asked_for(recording)
    expected = f"{NEAREST} to {FARTHEST} m from robot to robot all the time, {GAP} m in the end"
    if missing := [name for name in names if not len(recording.signal(f"truth/{name}/distance"))]:
        return Finding(False, expected, f"there was no {missing[0]}")
    paths = {}
    for name in names:
        along, across = (recording.signal(f"truth/{name}/{axis}") for axis in ("x", "y"))
        paths[name] = (along.times / 1e9, along.values, across.values)
    driven = {name: recording.signal(f"truth/{name}/distance").values[-1] for name in names}
    if driven["robot1"] < 1.0:
        return Finding(False, expected, f"robot1 drove {driven['robot1']:.1f} m only: the commands did not reach it")
    for front, name in itertools.pairwise(names):
        sent = follower_fits.heard(recording, name, front)
        if driven[name] < 0.3:
            why = "its node publishes no speed above zero"
            seen = _stopped(recording, sent) or suspect(recording, "first_kept", "whole_speed")
            seen = seen or (follower_fits.seen_elsewhere(sent) if sent else "")
            if said := seen or follower_origins.sideways(recording, name):
                why = f"its node publishes no speed above zero: {said}"
            elif few := follower_ends.few(recording, name):
                why = few
            elif sent and (said := follower_fits.speed(sent)):
                said = suspect(recording, "gap") or said
                why = f"its node publishes no speed above zero: {said}" if not sent[0].linear.any() else said
            elif not recording.has(f"topics/{name}/{DRIVES}/count"):
                why = f"its node publishes nothing on /{name}/{DRIVES}"
                why = follower_ends.unheard(recording.facts().get("endpoints", []), name, front) or why
                if not any(bridge.ros_topic == "/clock" and bridge.to_ros for bridge in bridges(recording)):
                    why = "no bridge carries /clock, so the timer of a node with use_sim_time never fires"
                    if wrong := next((b for b in bridges(recording) if b.ros_topic == "/clock"), None):
                        why = (
                            f"/clock is bridged with the direction {wrong.direction}, so ROS gets no time and the "
                            "timers of its nodes never fire: it comes from Gazebo, [gz.msgs.Clock"
                        )
            return Finding(False, expected, f"{name} stayed where it was", explanation=why)
        stepped = sent and len(np.unique(np.round(sent[0].linear, 2))) <= STEPS
        reason = _stopped(recording, sent) or suspect(recording, "first_kept", *["whole_speed"] * bool(stepped))
        reason = reason or follower_ends.few(recording, name) or follower_origins.sideways(recording, name)
        reason = reason or (_reason(sent) if sent else "")
        reason += convoy_rows.added_up(reason, names.index(name))
        if HEADING in reason:
            reason = suspect(recording, "heading", "angle") or reason
        reason = reason or _late(recording, name, front) or follower_ends.too_seldom(recording, name)
        reason = reason or suspect(recording, "heading", "angle")
        times, x, y = paths[name]
        front_times, front_x, front_y = paths[front]
        gap = np.hypot(np.interp(times, front_times, front_x) - x, np.interp(times, front_times, front_y) - y)
        worst = int(np.argmax(np.abs(gap - GAP)))
        if not NEAREST <= gap.min() <= gap.max() <= FARTHEST:
            measured = f"{called}, {name} was {gap[worst]:.2f} m from {front} at {times[worst]:.1f} s"
            why = "it drives on where the distance is the gap, and should stand there"
            if gap[worst] > GAP:
                meanwhile = follower_origins.behind(sent) if sent else ""
                why = "it falls behind, or turns another way than to the place of the robot in front"
                why = f"it falls behind: {meanwhile}" if meanwhile else why
            return Finding(False, expected, measured, float(times[worst]), explanation=reason or why)
        if abs(gap[-1] - GAP) > AT_REST:
            measured = f"{called}, {name} ended {gap[-1]:.2f} m from {front}"
            return Finding(False, expected, measured, float(times[-1]), explanation=reason)
    return Finding(True, expected, f"{called}, all {len(names)} robots kept together")
