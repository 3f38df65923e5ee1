"""Does the cart stand in front of the wall, and if not: which end, message or misconception is behind it?"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np

from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.grader.score.graphs import bridges
from gz_course.grader.score.launched import declared, launch_facts

from . import misconceptions
from .evidence import COMMANDS, MOUNT, RANGE, ends_of, suspected_in

WARNING = re.compile(r"^\[[^\]]+\] \[WARN\] (?:\[[\d.]+\] )?\[(\w+)\]: (.*)")  # of a node, in the log of the launch


def parks(recording: Recording, parameters: dict[str, Any]) -> Finding:
    trial = json.loads(recording.properties("run").get("trial_parameters", "{}"))
    wanted, tolerance = float(trial.get("parameters", {}).get("stop_at", 1.0)), parameters["tolerance"]
    expected = f"it stands {wanted:g} m from the wall (+- {tolerance:g} m) in the last second, and touches nothing"
    x, y = (recording.signal(f"truth/robot/{axis}") for axis in "xy")
    wall = recording.poses("world/wall")
    if not len(x) or wall is None:
        return Finding(False, expected, "nothing was simulated")
    qx, qy, qz, qw = wall.quaternions[0]
    normal = np.array([1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy + qz * qw)])
    places = np.stack([x.values, y.values], axis=1)
    world = Path(str(trial.get("parameters", {}).get("world", "bay.sdf"))).stem
    ran = [Path(str(each["world"])).stem for each in launch_facts(recording).get("simulators", []) if each["ran"]]
    if ran and world not in ran:
        why = f"the world that world:=... names is to be simulated, here {world}.sdf: LaunchConfiguration('world')"
        return Finding(False, expected, f"the world {ran[0]} was simulated, not {world}", explanation=why)
    away = np.abs((places - wall.positions[0][:2]) @ normal) - 0.05
    deaf = _why_deaf(recording) or _why_stale(recording)
    why = deaf or _why_there(recording, x.times, away, wanted)
    if recording.signal("truth/robot/distance").values[-1] < 0.1:
        return Finding(False, expected, "the cart stood still", explanation=deaf or _why_still(recording) or why)
    if away.min() < min(wanted - tolerance, 0.23):
        return Finding(False, expected, f"it came within {away.min():.2f} m of the wall", explanation=why)
    last = away[x.times >= x.times[-1] - 1_000_000_000]
    if x.times[-1] < 8e9:
        return Finding(False, expected, f"the run ended after {x.times[-1] / 1e9:.1f} s")
    worst = last[np.argmax(np.abs(last - wanted))]
    right = bool(abs(worst - wanted) <= tolerance)
    return Finding(right, expected, f"it stood {worst:.2f} m from the wall", explanation="" if right else why)


def _why_deaf(recording: Recording) -> str:
    """Return which two ends of /wall or /cmd_vel do not connect: one asks for more than the other offers."""
    takes = [(e["node"], e["topic"], e) for e in ends_of(recording, "subscription", RANGE)]
    for each in bridges(recording):
        if each.ros_topic == COMMANDS and each.subscription_qos is not None:
            takes.append(("the bridge", COMMANDS, vars(each.subscription_qos)))
    for node, topic, wanted in takes:
        for end in ends_of(recording, "publisher", topic=topic):
            for policy, strong, weak in (
                ("reliability", "RELIABLE", "BEST_EFFORT"),
                ("durability", "TRANSIENT_LOCAL", "VOLATILE"),
            ):
                if wanted[policy] == strong and end[policy] == weak:
                    return (
                        f"{node} asks for the {policy} {strong} on {topic}, and {end['node']} offers {weak}: not one "
                        "message arrives"
                    )
    return ""


def _why_stale(recording: Recording) -> str:
    """Return that the distances have no time; empty if they have one, or none came."""
    stamps = recording.signal("topics/wall/header/stamp").values
    if not len(stamps) or np.any(stamps):
        return ""
    return (
        "the time of every distance on /wall is 0: ranger_node.py does not set header.stamp, so the driver takes each "
        "for too old"
    )


def _why_still(recording: Recording) -> str:
    """Return what the logs and the messages say about a cart that does not drive."""
    heard, commands = (len(recording.signal(f"topics/{name}")) for name in ("wall/range", "cmd_vel/count"))
    said = [match for line in recording.lines("log/student") if (match := WARNING.match(line.text))]
    ranger = next((match.group(2) for match in said if match.group(1) == "ranger"), "")
    if not heard:
        why = "the ranger published no distance on /wall" + (f"; it warned: {ranger}" if ranger else "")
        held = [e for e in recording.facts().get("conditions", []) if e["file"] == "ranger_node.py"]
        if held:
            code = ", ".join(f"`{each['code']}` in line {each['line']}" for each in held)
            why += f"; before its publish() stand {code} (ranger_node.py)"
        if places := suspected_in(recording, "ranger_node.py", "age", "young_age", "hidden"):
            why = f"{places}; {why.partition('; before')[0]}"
        return why
    if not commands:
        silent = f"the driver got {heard} distances and published no command"
        loops = [each for each in recording.facts().get("slips", []) if "in the callback" in each["said"]]
        if any(each.get("file") == "driver_node.py" for each in loops):
            silent += ": one of its callbacks hangs, and waits for what only another callback of the node could bring"
        return silent
    return ""


def _why_there(recording: Recording, times: np.ndarray, away: np.ndarray, wanted: float) -> str:
    """Return which misconception the distances on /wall, or the commands on /cmd_vel, fit."""
    measured, command = recording.signal("topics/wall/range"), recording.signal("topics/cmd_vel/linear/x")
    if not len(measured):
        return ""
    truth = np.interp(measured.times, times, away)
    if said := misconceptions.of_a_distance(measured.values, truth, MOUNT[0]):
        if "wrong sign" in said and (place := suspected_in(recording, "ranger_node.py", "exchanged_frames")):
            return place
        if "every distance is" in said and (place := suspected_in(recording, "ranger_node.py", "first_kept")):
            return f"{place} ({said})"
        return f"{said} (/wall, ranger_node.py)"
    if not len(command):
        return ""
    held = [each for each in recording.facts().get("conditions", []) if each["file"] == "driver_node.py"]
    if said := misconceptions.of_an_end(times[-1], command.times[-1], command.values[-1], held):
        return said
    before = np.searchsorted(measured.times, command.times, side="left") - 1  # the driver takes it after its timer
    known = before >= 0
    heard, speed = measured.values[before[known]], command.values[known]
    kept = misconceptions.of_kept_distances(command.times[known], heard, speed, wanted) if known.any() else ""
    said = kept or misconceptions.of_a_driver(heard, speed, wanted)
    if "stop_at says" in said and (missing := declared(recording, "stop_at", "1.0")):
        return missing
    kinds = {"is not renewed": ("first_kept",), "stop_at says": ("hidden", "first_kept")}
    kinds |= {"every command is zero": ("age", "hidden", "young_age"), "however far": ("first_kept", "setpoint")}
    kinds |= {"distances are dropped": ("young_age",)}
    about = next((kinds[words] for words in kinds if words in said), ())
    for file in ("driver_node.py", "ranger_node.py")[: 1 + ("young_age" in about)]:
        if place := suspected_in(recording, file, *about):
            return f"{place} ({said})"
    places = [each for each in recording.facts().get("before_speeds", []) if each["file"] == "driver_node.py"]
    if "every command is zero" in said and (other := _another_axis(recording)):
        return f"the driver sets {other} of the command, and a cart drives ahead by linear.x (/cmd_vel, driver_node.py)"
    if places and said.startswith("every command is zero"):
        said += "; the speed is set only where these hold: "
        said += ", and ".join(f"`{each['code']}` in line {each['line']}" for each in places)
    return f"{said} (/cmd_vel, driver_node.py)" if said else ""


def _another_axis(recording: Recording) -> str:
    """Return which part of the commands is not zero, if linear.x always is; else nothing."""
    parts = ("linear.y", "linear.z", "angular.z", "angular.x", "angular.y")
    values = {part: recording.signal(f"topics/cmd_vel/{part.replace('.', '/')}").values for part in parts}
    return next((part for part, each in values.items() if np.any(np.abs(each) > 0.01)), "")
