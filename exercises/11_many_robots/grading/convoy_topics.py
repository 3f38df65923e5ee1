"""Checks of the names in ROS: what is bridged for each robot, and what each follower hears and steers."""

from __future__ import annotations

import itertools
import re
from typing import Any

from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.grader.score.graphs import bridges
from gz_course.grader.score.launched import deaths, launch_facts, ran

from . import follower_ends
from .convoy import DRIVES, HEARS, asked_for, robots_there

OF_A_ROBOT = re.compile(r"/robot\d+/")
TYPES = {"ROS_TO_GZ": "geometry_msgs/msg/Twist", "GZ_TO_ROS": "nav_msgs/msg/Odometry"}


def one_clock(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if exactly one bridge carries the clock."""
    expected = "one bridge for /clock, from Gazebo to ROS"
    found = [bridge for bridge in bridges(recording) if bridge.ros_topic == "/clock"]
    if not found:
        near = [b.ros_topic for b in bridges(recording) if b.ros_topic.endswith("/clock")]
        why = "nodes look for /clock, in whatever namespace they are" if near else ""
        return Finding(
            False, expected, f"no bridge publishes /clock{', but ' + near[0] if near else ''}", explanation=why
        )
    if len(found) > 1:
        why = "every message of the clock then comes as often: bridge it outside of what makes a robot"
        return Finding(False, expected, f"{len(found)} bridges publish /clock", explanation=why)
    if found[0].direction != "GZ_TO_ROS":
        why = "the clock comes from Gazebo: GZ_TO_ROS, or [ between the two types"
        return Finding(False, expected, f"the direction of /clock is {found[0].direction}", explanation=why)
    return Finding(found[0].to_ros > 5, expected, f"{found[0].to_ros} messages of the clock came")


def name_in(topic: str) -> str:
    """Return the first part of a topic's name: the robot of /robot1/odom."""
    return topic.split("/")[1]


def own_topics(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if every robot's commands and odometry are bridged below its name, each way once."""
    names, called = judged(recording)
    made = bridges(recording)
    wanted = {}
    for name in names:
        wanted[f"/{name}/{DRIVES}"] = (f"/model/{name}/cmd_vel", "ROS_TO_GZ")
        wanted[f"/{name}/{HEARS}"] = (f"/model/{name}/odometry", "GZ_TO_ROS")
    expected = f"{called}: /robot1/cmd_vel, /robot1/odom and so on, each bridged with the topic of the same robot"
    for topic, (gz_topic, direction) in wanted.items():
        here = [bridge for bridge in made if bridge.ros_topic == topic]
        if not here:
            other = next((b.ros_topic for b in made if b.gz_topic == gz_topic), "")
            why = ""
            nodes = [each["node"] for each in launch_facts(recording).get("bridges_started", [])]
            spaces = {node.rpartition("/")[0] for node in nodes}
            if other in ("/cmd_vel", "/odom") and f"/{name_in(topic)}" in spaces:
                why = (
                    f"a namespace is not put before a name that begins with /, so {other} is one topic of all robots "
                    f"although the bridge runs in the namespace /{name_in(topic)}: {other[1:]} without the /, or "
                    f"{topic}, is the name to remap to"
                )
            elif other in ("/cmd_vel", "/odom"):
                why = "without a namespace, the topics of all robots are one"
            elif other.startswith(f"/{name_in(topic)}/{name_in(topic)}/"):
                why = (
                    f"a name that does not begin with / is put into the namespace of the bridge, /{name_in(topic)}, "
                    f"which then stands there twice: {topic.rpartition('/')[2]} or {topic} is the name to remap to"
                )
            elif own := [node for node in nodes if other.startswith(f"{node}/")]:
                why = _private(other, own[0])
            elif other == gz_topic:
                why = f"a remapping to {topic} is missing, or its two names are exchanged: (from, to)"
                if f"/{name_in(topic)}" in spaces:
                    why = "a namespace does not change a name that begins with /: each needs a remapping (from, to)"
            elif other:
                why = f"its name in ROS should be {topic}: the second of the two names of its remapping"
            measured = f"no bridge has {topic}" + (f"; {gz_topic} is bridged as {other}" if other else "")
            return Finding(False, expected, measured, explanation=why)
        if len(here) > 1:
            measured = f"{len(here)} bridges have {topic}: every message is carried as often"
            return Finding(False, expected, measured, explanation=f"{measured}; each topic needs one bridge")
        if here[0].gz_topic != gz_topic:
            measured = f"{topic} is bridged with {here[0].gz_topic}, not with {gz_topic}"
            why = "these are two different robots"
            if here[0].gz_topic.startswith(f"/model/{name_in(topic)}/"):
                why = f"DiffDrive has no such topic in Gazebo: it is called {gz_topic}"
            elif not here[0].gz_topic.startswith("/model/"):
                why = f"ROS namespaces do not count in Gazebo: bridge {gz_topic}, and remap it to {topic}"
            return Finding(False, expected, measured, explanation=why)
        if here[0].direction != direction:
            why = "commands go from ROS to Gazebo, ]" if topic.endswith(DRIVES) else "odometry comes from Gazebo, ["
            measured = f"{topic} has the direction {here[0].direction}, not {direction}"
            return Finding(False, expected, measured, explanation=why)
    for topic, (_, direction) in wanted.items():
        kind, given = TYPES[direction], next(b.ros_type for b in made if b.ros_topic == topic)
        if given != kind:
            measured = f"{topic} is bridged as {given}, not as {kind}"
            why = "DDS connects equal types only, and all others use the type of the task"
            return Finding(False, expected, measured, explanation=why)
    silent = [t for t in wanted if t.endswith(HEARS) and not next(b.to_ros for b in made if b.ros_topic == t)]
    if silent:
        paused = any(each["paused"] for each in ran(recording))
        there = ", ".join(robots_there(recording)) or "none"
        why = f"no robot of that name is in the world: there are {there}"
        if not paused and not robots_there(recording):
            return Finding(False, expected, "no robot came into the world", gated=True)
        why = "without -r the simulator starts paused" if paused else why
        return Finding(False, expected, f"no message came on {silent[0]}", explanation=why)
    return Finding(True, expected, f"{len(wanted)} topics of {len(names)} robots")


def judged(recording: Recording) -> tuple[list[str], str]:
    """Return the robots that were asked for and are there; all that were asked for if they are too few for a convoy."""
    names, called = asked_for(recording)
    there = [name for name in names if name in robots_there(recording)]
    return (there if len(there) > 1 else names), called


def listens_to_the_one_in_front(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if each follower has the subscriptions and the publisher that its place in the row asks for."""
    names, called = judged(recording)
    expected = f"{called}: /robot2/follower hears /robot1/odom and /robot2/odom, steers /robot2/cmd_vel, and so on"
    if died := next(
        (each for each in deaths(recording) if "follower" in each.process or "python" in each.process), None
    ):
        measured = f"a follower ended with exit code {died.code}{died.words}"
        return Finding(False, expected, measured, explanation=died.why)
    ends = [e for e in recording.facts().get("endpoints", []) if not e["topic"].startswith(("/rosout", "/parameter"))]
    nodes = {end["node"] for end in ends}
    drivers = sorted(e["node"] for e in ends if (e["kind"], e["topic"]) == ("publisher", f"/robot1/{DRIVES}"))
    if drivers:
        why = "the first robot has nobody in front, so it gets no follower" if "/robot1/" in drivers[0] else ""
        why = why or ("it steers the robot in front instead of its own" if "/robot2/" in drivers[0] else "")
        measured = f"{drivers[0]} publishes on /robot1/cmd_vel, which somebody else drives"
        return Finding(False, expected, measured, explanation=why)
    for front, name in itertools.pairwise(names):
        node = f"/{name}/follower"
        if node not in nodes:
            others = named = sorted(each for each in nodes if each.endswith("follower"))
            others = others or sorted(each for each in nodes if each.startswith(f"/{name}/"))
            why = f"the name of the node is to be follower, in the namespace /{name}" if others else ""
            if all(each.endswith("/follower") for each in others):
                why = ""
            if named and len(names) > 2 and len(named) < len(names) - 1:
                why = follower_ends.one_name_for_several(follower_ends.started(recording), others) or why
                why = why or follower_ends.missing(name, names, others)
            if "/follower" in others:
                why = "its node has no namespace: all followers have the same name"
            if not others and (program := follower_ends.no_program(recording)):
                why = f"there is no program '{program}'"
                if " " in program:
                    why = "the whole command line is one word: cmd is a list of words, [sys.executable, file, ...]"
            elif not others and not why and robots_there(recording) and not follower_ends.started(recording):
                why = (
                    "the launch has started nothing but simulator, bridges and create: the action that starts "
                    "follower_node.py is in no list that is returned, or waits for an event that never comes"
                )
            measured = f"there was no node {node}" + (f"; there was {', '.join(others)}" if others else "")
            return Finding(False, expected, measured, explanation=why)
        heard = sorted({e["topic"] for e in ends if e["node"] == node and e["kind"] == "subscription"} - {"/clock"})
        told = sorted(e["topic"] for e in ends if e["node"] == node and e["kind"] == "publisher")
        wanted = sorted({f"/{front}/{HEARS}", f"/{name}/{HEARS}"})
        if heard != wanted:
            why = ""
            if any(topic in heard for topic in ("/odom", "/cmd_vel")):
                why = "a name that begins with / has no namespace"
            elif heard == sorted({f"/robot1/{HEARS}", f"/{name}/{HEARS}"}):
                why = f"in front of {name} is {front}, not robot1"
            elif below := [topic for topic in heard if topic.startswith(f"/{name}/") and topic.count("/") > 2]:
                why = _below_its_namespace(below[0], name, wanted)
                if sorted(heard) == sorted([f"/{front}/{HEARS}", f"/{name}/front/{HEARS}"]):
                    why = (
                        f"{HEARS}, its own odometry, is remapped to /{front}/{HEARS}, and front/{HEARS} is not: the "
                        f"rule is front/{HEARS}:=/{front}/{HEARS}"
                    )
            elif heard == [f"/{name}/{HEARS}"]:
                why = f"it hears only its own odometry: that of the robot in front is /{front}/{HEARS}"
            elif heard == [f"/{front}/{HEARS}"]:
                why = "it hears only the robot in front, and not its own odometry"
            elif fixed := [t for t in heard if t not in wanted and not OF_A_ROBOT.match(t)]:
                why = (
                    f"{fixed[0]} begins with / in the node, so it is in no namespace, and a remapping of "
                    f"{fixed[0][1:]} does not change it: write {fixed[0][1:]} in create_subscription, without the /"
                )
            elif behind := [topic for topic in heard if topic not in wanted and topic.endswith(f"/{HEARS}")]:
                why = f"in front of {name} is {front}: {behind[0]} is that of another robot"
            return Finding(False, expected, f"{node} hears {', '.join(heard) or 'nothing'}", explanation=why)
        if told != [f"/{name}/{DRIVES}"]:
            why = ""
            if told == [f"/{DRIVES}"]:
                why = "a name that begins with / has no namespace"
            elif told == [f"/{front}/{DRIVES}"]:
                why = "it steers the robot in front instead of its own"
            elif told and told[0].startswith(f"{node}/"):
                why = _private(told[0], node)
            elif told and told[0].startswith(f"/{name}/"):
                why = f"the topic of its robot is /{name}/{DRIVES}"
            measured = f"{node} publishes on {', '.join(told) or 'nothing'}"
            return Finding(False, expected, measured, explanation=why)
        if not any(e["node"] == node and e["topic"] == "/clock" for e in ends):
            why = follower_ends.without_sim_time(recording, "follower_node.py")
            measured = f"{node} has no use_sim_time: its timer runs on the computer's time"
            return Finding(False, expected, measured, explanation=why)
    return Finding(True, expected, f"{len(names) - 1} followers, so it was")


def _below_its_namespace(topic: str, name: str, wanted: list[str]) -> str:
    """Return why a subscription is below the follower's own namespace."""
    relative = topic.removeprefix(f"/{name}/")
    if relative == f"front/{HEARS}":
        return f"front/{HEARS} was not remapped: it stays a name below /{name}"
    if relative.startswith("follower/"):
        return _private(topic, f"/{name}/follower")
    write = f": write /{relative}" if f"/{relative}" in wanted else ""
    return f"{relative} does not begin with /, so it is put into the namespace /{name}{write}"


def _private(topic: str, node: str) -> str:
    """Explain the name of a topic that has the node's own name in it."""
    last, space = topic.removeprefix(f"{node}/"), node.rpartition("/")[0]
    return (
        f"{topic} has the name of the node in it: ~ stands for namespace and name of a node, {node}; {last} without ~ "
        f"becomes {space}/{last}"
    )
