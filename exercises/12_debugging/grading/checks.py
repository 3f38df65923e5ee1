"""Checks of the repaired system: each looks at one fault, in the graph, in the bridge or in the truth."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np

from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.grader.score.graphs import bridges
from gz_course.grader.score.launched import complaint, deaths, declared, launch_facts, logged_error, simulator_fault

from . import misconceptions, names

SCAN, COMMANDS, LASER_SCAN, RANGE = "/scan", "/cmd_vel", "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Range"
WORLDS = ("bay.sdf", "depot.sdf")  # in the folder `worlds` beside the launch file
FRAMES, MOUNT = ("base_link", "lidar_link"), (-0.2, 0.0, 0.19)  # parent and child; the child in the parent [m]
WARNING = re.compile(r"^\[[^\]]+\] \[WARN\] (?:\[[\d.]+\] )?\[(\w+)\]: (.*)")  # of a node, in the log of the launch


def _ends(recording: Recording, kind: str, type: str | None = None, topic: str | None = None) -> list[Any]:
    found = recording.facts().get("endpoints", [])
    return [e for e in found if e["kind"] == kind and type in (None, e["type"]) and topic in (None, e["topic"])]


def time_runs(recording: Recording, parameters: dict[str, Any]) -> Finding:
    expected = "a simulator that runs from its start, with -r"
    ran = [each for each in launch_facts(recording).get("simulators", []) if each["ran"]]
    if not ran and recording.ended_s > 0:
        return Finding(False, expected, f"gz sim ended by itself after {recording.ended_s:.1f} s of simulated time")
    if not ran:
        errors = [each["error"] for each in launch_facts(recording).get("simulators", []) if each["error"]]
        said = errors[0] if errors else complaint(recording, "gz sim")
        measured = f"no simulator ran{f'; gz sim said: {said}' if said else ''}"
        why = simulator_fault(said, recording)
        if any(f"{world}' was not found" in said for world in WORLDS):
            why = (
                "the world is looked for in the folder in which ros2 launch was called, and it lies in worlds, beside "
                "the launch file: PathJoinSubstitution([str(HERE / 'worlds'), LaunchConfiguration('world')])"
            )
        return Finding(False, expected, measured, explanation=why)
    if ran[0]["paused"]:
        return Finding(False, expected, "the world was started paused: gz sim had no -r")
    return Finding(recording.ended_s > 0, expected, f"{recording.ended_s:.1f} s were simulated")


def commands_go_to_gazebo(recording: Recording, parameters: dict[str, Any]) -> Finding:
    expected = "/cmd_vel -> /model/robot/cmd_vel, ROS_TO_GZ"
    found = [each for each in bridges(recording) if each.gz_topic == "/model/robot/cmd_vel"]
    if not found:
        others = [each for each in bridges(recording) if each.ros_topic == COMMANDS]
        measured = "no bridge has the Gazebo topic /model/robot/cmd_vel"
        exchanged = [each for each in bridges(recording) if each.ros_topic == "/model/robot/cmd_vel"]
        if exchanged:
            measured = (
                f"{exchanged[0].place}: ros_topic_name and gz_topic_name are exchanged: the cart listens to "
                f"/model/robot/cmd_vel in Gazebo, and the driver publishes {COMMANDS} in ROS"
            )
            if exchanged[0].gz_topic != COMMANDS:
                measured = f"{exchanged[0].place}: /model/robot/cmd_vel is the name in Gazebo; in ROS, it is {COMMANDS}"
        elif others:
            measured = (
                f"{others[0].place}: /cmd_vel is joined with Gazebo's {others[0].gz_topic}, where the cart does not "
                "listen: it listens to /model/robot/cmd_vel"
            )
        elif said := logged_error(recording, "parameter_bridge"):
            said = re.sub(r"^\S*?([^/\s:]+):(\d+)(?::\d+)?: ", r"\1, line \2: ", said)
            return Finding(False, expected, measured, explanation=f"parameter_bridge said: {said}")
        return Finding(False, expected, measured)
    if len(found) > 1:
        return Finding(
            False, expected, f"{len(found)} bridges have the Gazebo topic /model/robot/cmd_vel; one is right"
        )
    bridge = found[0]
    if bridge.ros_topic != COMMANDS:
        return Finding(False, expected, f"{bridge.place}: its ROS topic is {bridge.ros_topic}, not /cmd_vel")
    if bridge.direction == "BIDIRECTIONAL":
        measured = f"{bridge.place}: /cmd_vel goes both ways (no direction means that); one way is right"
        return Finding(False, expected, measured)
    if bridge.direction != "ROS_TO_GZ":
        return Finding(False, expected, f"{bridge.place}: /cmd_vel goes the wrong way, {bridge.direction}")
    if bridge.ros_type != "geometry_msgs/msg/Twist" or bridge.gz_type != "gz.msgs.Twist":
        measured = (
            f"{bridge.place}: the types of /cmd_vel are {bridge.ros_type} and {bridge.gz_type} here; in this system "
            "they are geometry_msgs/msg/Twist and gz.msgs.Twist"
        )
        return Finding(False, expected, measured)
    return Finding(True, expected, "so it is")


def scans_are_heard(recording: Recording, parameters: dict[str, Any]) -> Finding:
    expected = "a subscription to /scan that asks for no more than the bridge offers"
    offers = [each for each in bridges(recording) if each.ros_topic == SCAN and each.publisher_qos is not None]
    if not offers or offers[0].gz_topic != "/lidar/scan" or offers[0].direction != "GZ_TO_ROS":
        measured = "the bridge does not carry /lidar/scan to /scan, one way"
        for each in bridges(recording):
            if (each.ros_topic, each.gz_topic) == (SCAN, "/lidar/scan") and each.direction != "GZ_TO_ROS":
                goes = (
                    "goes both ways" if each.direction == "BIDIRECTIONAL" else f"goes the wrong way, {each.direction}"
                )
                return Finding(False, expected, f"{each.place}: /scan {goes}; scans come from Gazebo: GZ_TO_ROS")
            if "/lidar/scan" in (each.gz_topic, each.ros_topic) or SCAN in (each.gz_topic, each.ros_topic):
                measured += (
                    f": {each.place}: /{each.ros_topic.lstrip('/')} in ROS, {each.gz_topic} in Gazebo, {each.direction}"
                )
                break
        return Finding(False, expected, measured)
    takes = _ends(recording, "subscription", LASER_SCAN, SCAN)
    if not takes:
        ends = _ends(recording, "subscription", LASER_SCAN)
        others = {each["topic"] for each in ends}
        where = f"; scans are taken from {min(others)}" if others else ""
        dead, why = _died(recording, "ranger"), names.of_a_node(ends, others)
        return Finding(False, expected, f"no node subscribes to /scan{where}", explanation=why, gated=dead)
    offer = offers[0].publisher_qos
    for end in takes:
        for policy, strong in (("durability", "TRANSIENT_LOCAL"), ("reliability", "RELIABLE")):
            if end[policy] == strong and getattr(offer, policy) != strong:
                measured = (
                    f"{end['node']} asks for the {policy} {strong} on /scan, the bridge offers "
                    f"{getattr(offer, policy)}: not one scan arrives"
                )
                return Finding(False, expected, measured)
    return Finding(True, expected, "so it is")


def same_topic(recording: Recording, parameters: dict[str, Any]) -> Finding:
    expected = "the ranger publishes the distance where the driver takes it"
    sends = {each["topic"] for each in _ends(recording, "publisher", RANGE)}
    takes = {each["topic"] for each in _ends(recording, "subscription", RANGE)}
    if not sends:
        dead = _died(recording, "ranger")
        return Finding(False, expected, "no node publishes a sensor_msgs/msg/Range", gated=dead)
    if not takes:  # the driver is dead, which another check says: then its topic is the one without a namespace
        right = sends == {"/wall"} and _died(recording, "driver")
        return Finding(right, expected, "so it is" if right else f"nobody takes the distance on {min(sends)}")
    if not sends & takes:
        measured = f"the distance is published on {min(sends)} and taken from {min(takes)}"
        ends = _ends(recording, "publisher", RANGE) + _ends(recording, "subscription", RANGE)
        rules = recording.facts().get("remappings", [])
        why = names.of_a_remapping(rules, ends, min(sends), min(takes))
        why = why or names.of_a_spelling(min(sends), min(takes)) or names.of_a_node(ends, sends | takes)
        return Finding(False, expected, measured, explanation=why)
    return Finding(True, expected, f"both use {min(sends & takes)}")


def _died(recording: Recording, name: str) -> Any:
    said = " ".join(line.text for line in recording.lines("log/student"))
    return f"{name}_node.py" in said and bool(list(deaths(recording)))


def lidar_frame(recording: Recording, parameters: dict[str, Any]) -> Finding:
    x, y, z = MOUNT
    expected = f"lidar_link at x = {x}, y = {y}, z = {z} m in base_link"
    name = "topics/tf_static/{}/{}/translation/x"
    ways = [recording.signal(name.format(*way)).values for way in (FRAMES, FRAMES[::-1])]
    if all(map(len, ways)):
        measured = (
            "the transform is published both ways: from base_link to lidar_link, and from lidar_link to base_link"
        )
        why = "the transform with lidar_link as the parent is still there; a frame has one parent, and base_link is it"
        return Finding(False, expected, measured, explanation=why)
    for (parent, child), sign in ((FRAMES, 1), (FRAMES[::-1], -1)):
        place = [recording.signal(f"topics/tf_static/{parent}/{child}/translation/{axis}").values for axis in "xyz"]
        if not all(map(len, place)):
            continue
        turn = [recording.signal(f"topics/tf_static/{parent}/{child}/rotation/{axis}").values[-1] for axis in "xyz"]
        seen = [sign * axis[-1] for axis in place]
        if any(abs(each) > 0.01 for each in turn):
            return Finding(False, expected, misconceptions.of_a_turned_mount(turn))
        if math.dist(seen, MOUNT) < 0.005:
            return Finding(True, expected, "so it is")
        measured = f"the transform says x = {seen[0]:.2f}, y = {seen[1]:.2f}, z = {seen[2]:.2f} m"
        return Finding(False, expected, measured, explanation=misconceptions.of_a_mount(seen, MOUNT, sign))
    others = sorted(
        {tuple(name.split("/")[2:4]) for name in recording.signals() if name.startswith("topics/tf_static/")}
        - {("count",)}
    )
    measured = "nobody publishes a static transform between base_link and lidar_link"
    dead = any(each.process == "static_transform_publisher" for each in deaths(recording))
    if others:
        measured += f"; one between {others[0][0]} and {others[0][1]} is published: frame names must be equal"
    return Finding(False, expected, measured, gated=dead)


def all_alive(recording: Recording, parameters: dict[str, Any]) -> Finding:
    # How a process ends after Ctrl-C is not asked: rclpy can lose a SIGINT, and the launch then sends SIGTERM.
    expected = "no process of the launch ends before Ctrl-C"
    facts = launch_facts(recording)
    ended = facts.get("ended_early", [])
    if dead := list(deaths(recording)):
        measured = f"{dead[0].process} ended with exit code {dead[0].code}{dead[0].words}"
        return Finding(False, expected, measured, explanation=dead[0].why)
    if ended:
        return names.ended_by_itself(recording, ended[0], expected)
    if not _ends(recording, "publisher", topic=COMMANDS):
        others = [each for each in _ends(recording, "publisher") if "Twist" in each["type"].rpartition("/")[2]]
        if others:
            space = others[0]["node"].rpartition("/")[0]
            if space and others[0]["topic"] == f"{space}{COMMANDS}":
                why = (
                    f"{others[0]['node']} lives in the namespace {space}, and its name {COMMANDS[1:]} has no slash at "
                    f"its beginning: it means {space}{COMMANDS}"
                )
                measured = f"the commands are published on {space}{COMMANDS}, not on {COMMANDS}"
                return Finding(False, expected, measured, explanation=why)
            measured = f"{others[0]['node']} publishes its commands on {others[0]['topic']}, not on {COMMANDS}"
            why = f"the topic of the commands in ROS is {COMMANDS}; bridge.yaml joins it with that of Gazebo"
            return Finding(False, expected, measured, explanation=why)
        return Finding(False, expected, "no node publishes /cmd_vel: the driver never ran")
    if not _ends(recording, "subscription", LASER_SCAN):
        return Finding(False, expected, "no node takes scans: the ranger never ran")
    if not recording.facts().get("sim_seconds") and not any(each.ros_topic == "/clock" for each in bridges(recording)):
        measured = "there is neither simulated time nor /clock: that the programs wait for them shows nothing yet"
        return Finding(False, expected, measured, gated=True)
    return Finding(True, expected, "so it is")


def simulated_time(recording: Recording, parameters: dict[str, Any]) -> Finding:
    expected = "the ranger and the driver follow /clock"
    follows = {each["node"] for each in _ends(recording, "subscription", topic="/clock")}
    ranger = {each["node"] for each in _ends(recording, "publisher", RANGE)}
    driver = {each["node"] for each in _ends(recording, "subscription", RANGE)} - ranger
    if not ranger:
        dead = _died(recording, "ranger")
        return Finding(False, expected, "no node publishes a sensor_msgs/msg/Range", gated=dead)
    for node in sorted(ranger | driver):
        if node not in follows:
            measured = f"{node} ran without use_sim_time: its clock is that of the computer"
            program = "ranger_node.py" if node in ranger else "driver_node.py"
            return Finding(False, expected, measured, explanation=_why_on_wall_time(recording, program))
    return Finding(True, expected, "so it is")


def _why_on_wall_time(recording: Recording, program: str) -> str:
    """Return which action starts a program without use_sim_time, and that it no longer asks how old a message is."""
    what, signal = ("scan", "wall/range") if program == "ranger_node.py" else ("distance", "cmd_vel/linear/x")
    places = recording.facts().get("programs", [])
    place = next((each for each in places if each["program"] == program and not each["sim_time"]), None)
    named = next((each for each in places if each["program"] == program and each.get("mentioned")), None)
    if named is not None and place is None:
        return (
            f"{named['file']}, line {named['line']}: use_sim_time is mentioned in this action, but {program} does not "
            "get the value True, or turns it off again"
        )
    said = f"{program} is started without use_sim_time"
    if place is not None:
        said = f"{place['file']}, line {place['line']}: {said}"
        if place["elsewhere"]:
            said += f"; line {place['elsewhere']} gives it to {place['executable'] or 'another program'} instead"
    if np.any(recording.signal(f"topics/{signal}").values):  # by its own clock, every message is many years old
        if hides := _suspects(recording, program, "any_age"):
            return f"{said}, and what would have shown that is switched off: {hides}"
        return f"{said}, and its check of how old a {what} is, which noticed that, no longer drops any: put it back"
    return said if place is not None else ""


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
    takes = [(e["node"], e["topic"], e) for e in _ends(recording, "subscription", RANGE)]
    for each in bridges(recording):
        if each.ros_topic == COMMANDS and each.subscription_qos is not None:
            takes.append(("the bridge", COMMANDS, vars(each.subscription_qos)))
    for node, topic, wanted in takes:
        for end in _ends(recording, "publisher", topic=topic):
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
        if places := _suspects(recording, "ranger_node.py", "age", "young_age", "hidden"):
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
        if "wrong sign" in said and (place := _suspects(recording, "ranger_node.py", "exchanged_frames")):
            return place
        if "every distance is" in said and (place := _suspects(recording, "ranger_node.py", "first_kept")):
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
        if place := _suspects(recording, file, *about):
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


def _suspects(recording: Recording, file: str, *about: str) -> str:
    """Return the first place in a file that is suspected of one of these things, with its words; empty if none is."""
    for each in recording.facts().get("suspects", []):
        if each.get("file") == file and each["about"] in about:
            return f"{file}, line {each['line']}: {each['said']}"
    return ""
