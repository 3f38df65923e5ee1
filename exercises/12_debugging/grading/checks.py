"""Checks of the repaired system: each looks at one fault, in the graph, in the bridge or in the truth."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np

from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.grader.score.graphs import bridges
from gz_course.grader.score.launched import complaint, deaths, launch_facts, logged_error, simulator_fault

from . import misconceptions, names
from .evidence import COMMANDS, FRAMES, LASER_SCAN, MOUNT, RANGE, SCAN, died, ends_of, suspected_in

WORLDS = ("bay.sdf", "depot.sdf")  # in the folder `worlds` beside the launch file


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
    takes = ends_of(recording, "subscription", LASER_SCAN, SCAN)
    if not takes:
        ends = ends_of(recording, "subscription", LASER_SCAN)
        others = {each["topic"] for each in ends}
        where = f"; scans are taken from {min(others)}" if others else ""
        dead, why = died(recording, "ranger"), names.of_a_node(ends, others)
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
    sends = {each["topic"] for each in ends_of(recording, "publisher", RANGE)}
    takes = {each["topic"] for each in ends_of(recording, "subscription", RANGE)}
    if not sends:
        dead = died(recording, "ranger")
        return Finding(False, expected, "no node publishes a sensor_msgs/msg/Range", gated=dead)
    if not takes:  # the driver is dead, which another check says: then its topic is the one without a namespace
        right = sends == {"/wall"} and died(recording, "driver")
        return Finding(right, expected, "so it is" if right else f"nobody takes the distance on {min(sends)}")
    if not sends & takes:
        measured = f"the distance is published on {min(sends)} and taken from {min(takes)}"
        ends = ends_of(recording, "publisher", RANGE) + ends_of(recording, "subscription", RANGE)
        rules = recording.facts().get("remappings", [])
        why = names.of_a_remapping(rules, ends, min(sends), min(takes))
        why = why or names.of_a_spelling(min(sends), min(takes)) or names.of_a_node(ends, sends | takes)
        return Finding(False, expected, measured, explanation=why)
    return Finding(True, expected, f"both use {min(sends & takes)}")


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
    if not ends_of(recording, "publisher", topic=COMMANDS):
        others = [each for each in ends_of(recording, "publisher") if "Twist" in each["type"].rpartition("/")[2]]
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
    if not ends_of(recording, "subscription", LASER_SCAN):
        return Finding(False, expected, "no node takes scans: the ranger never ran")
    if not recording.facts().get("sim_seconds") and not any(each.ros_topic == "/clock" for each in bridges(recording)):
        measured = "there is neither simulated time nor /clock: that the programs wait for them shows nothing yet"
        return Finding(False, expected, measured, gated=True)
    return Finding(True, expected, "so it is")


def simulated_time(recording: Recording, parameters: dict[str, Any]) -> Finding:
    expected = "the ranger and the driver follow /clock"
    follows = {each["node"] for each in ends_of(recording, "subscription", topic="/clock")}
    ranger = {each["node"] for each in ends_of(recording, "publisher", RANGE)}
    driver = {each["node"] for each in ends_of(recording, "subscription", RANGE)} - ranger
    if not ranger:
        dead = died(recording, "ranger")
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
        if hides := suspected_in(recording, program, "any_age"):
            return f"{said}, and what would have shown that is switched off: {hides}"
        return f"{said}, and its check of how old a {what} is, which noticed that, no longer drops any: put it back"
    return said if place is not None else ""
