"""Checks that only this exercise needs: a row of robots, their names in ROS, and the gaps between them."""

import itertools
import math

import numpy as np

from gz_course.grader.score.check import Finding
from gz_course.grader.score.graphs import bridges
from gz_course.grader.score.launched import argument, complaint, deaths, ran

GAP = 1.2  # [m]
ROW = 0.15  # [m] that a robot may start beside its place
NEAREST, FARTHEST = 0.75, 1.75  # [m] between two robots at any time
AT_REST = 0.3  # [m] that the gap may be off in the end
DRIVES, HEARS = "cmd_vel", "odom"


def _names(recording):
    count, called = argument(recording, "robots", "2")
    return [f"robot{number}" for number in range(1, int(count) + 1)], called


def _there(recording):
    return sorted({name.split("/")[1] for name in recording.signals() if name.startswith("truth/")})


def in_a_row(recording, parameters):
    """Pass if exactly the robots that were asked for are there, each in its place."""
    names, called = _names(recording)
    expected = f"{called}: {', '.join(names)} in a row, {GAP} m apart"
    there = _there(recording)
    if not there:
        said = complaint(recording, "create") or next((d.words for d in deaths(recording) if d.process == "create"), "")
        why = "" if said else "create of ros_gz_sim puts a model into a running world"
        return Finding(False, expected, f"no robot came into the world{': ' if said else ''}{said}", explanation=why)
    if there != sorted(names):
        why = ""
        if len(there) < len(names) and there == sorted(names)[: len(there)]:
            why = f"the argument robots has no effect, or a create failed: {len(names)} robots were asked for"
        elif len(there) > len(names):
            why = f"the argument robots has no effect: {len(names)} robots were asked for"
        return Finding(False, expected, f"{called}, there were {', '.join(there)}", explanation=why)
    for number, name in enumerate(names):
        x, y = (recording.signal(f"truth/{name}/{axis}").values[0] for axis in ("x", "y"))
        if math.hypot(x + GAP * number, y) > ROW:
            return Finding(False, expected, f"{name} began at x {x:.2f} m, y {y:.2f} m, not at x {-GAP * number:.2f} m")
    return Finding(True, expected, f"{called}, so it was")


def one_clock(recording, parameters):
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
        return Finding(False, expected, f"the direction of /clock is {found[0].direction}")
    return Finding(found[0].to_ros > 5, expected, f"{found[0].to_ros} messages of the clock came")


def own_topics(recording, parameters):
    """Pass if every robot's commands and odometry are bridged below its name, each way once."""
    names, called = _names(recording)
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
            if other in ("/cmd_vel", "/odom"):
                why = "without a namespace, the topics of all robots are one"
            measured = f"no bridge has {topic}" + (f"; {gz_topic} is bridged as {other}" if other else "")
            return Finding(False, expected, measured, explanation=why)
        if len(here) > 1:
            return Finding(False, expected, f"{len(here)} bridges have {topic}: every message is carried as often")
        if here[0].gz_topic != gz_topic:
            measured = f"{topic} is bridged with {here[0].gz_topic}, not with {gz_topic}"
            return Finding(False, expected, measured, explanation="these are two different robots")
        if here[0].direction != direction:
            return Finding(False, expected, f"{topic} has the direction {here[0].direction}, not {direction}")
    silent = [t for t in wanted if t.endswith(HEARS) and not next(b.to_ros for b in made if b.ros_topic == t)]
    if silent:
        paused = any(each["paused"] for each in ran(recording))
        there = ", ".join(_there(recording)) or "none"
        why = f"no robot of that name is in the world: there are {there}"
        why = "without -r the simulator starts paused" if paused else why
        return Finding(False, expected, f"no message came on {silent[0]}", explanation=why)
    return Finding(True, expected, f"{len(wanted)} topics of {len(names)} robots")


def listens_to_the_one_in_front(recording, parameters):
    """Pass if each follower has the subscriptions and the publisher that its place in the row asks for."""
    names, called = _names(recording)
    expected = f"{called}: /robot2/follower hears /robot1/odom and /robot2/odom, steers /robot2/cmd_vel, and so on"
    if died := next(
        (each for each in deaths(recording) if "follower" in each.process or "python" in each.process), None
    ):
        return Finding(False, expected, f"a follower ended with exit code {died.code}{died.words}")
    ends = [e for e in recording.facts().get("endpoints", []) if not e["topic"].startswith(("/rosout", "/parameter"))]
    nodes = {end["node"] for end in ends}
    drivers = sorted(e["node"] for e in ends if (e["kind"], e["topic"]) == ("publisher", f"/robot1/{DRIVES}"))
    if drivers:
        return Finding(False, expected, f"{drivers[0]} publishes on /robot1/cmd_vel, which somebody else drives")
    for front, name in itertools.pairwise(names):
        node = f"/{name}/follower"
        if node not in nodes:
            others = sorted(each for each in nodes if each.endswith("follower"))
            why = ""
            if "/follower" in others:
                why = "its node has no namespace: all followers have the same name"
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
            return Finding(False, expected, f"{node} hears {', '.join(heard) or 'nothing'}", explanation=why)
        if told != [f"/{name}/{DRIVES}"]:
            return Finding(False, expected, f"{node} publishes on {', '.join(told) or 'nothing'}")
        if not any(e["node"] == node and e["topic"] == "/clock" for e in ends):
            return Finding(False, expected, f"{node} has no use_sim_time: its timer runs on the computer's time")
    return Finding(True, expected, f"{len(names) - 1} followers, so it was")


def keeps_together(recording, parameters):
    """Pass if the first robot drives, and each other one is behind the one in front all the time."""
    names, called = _names(recording)
    expected = f"{NEAREST} to {FARTHEST} m from robot to robot all the time, {GAP} m in the end"
    if missing := [name for name in names if not len(recording.signal(f"truth/{name}/distance"))]:
        return Finding(False, expected, f"there was no {missing[0]}")
    paths = {}
    for name in names:
        x, y = (recording.signal(f"truth/{name}/{axis}") for axis in ("x", "y"))
        paths[name] = (x.times / 1e9, x.values, y.values)
    driven = {name: recording.signal(f"truth/{name}/distance").values[-1] for name in names}
    if driven["robot1"] < 1.0:
        return Finding(False, expected, f"robot1 drove {driven['robot1']:.1f} m only: the commands did not reach it")
    for front, name in itertools.pairwise(names):
        if driven[name] < 0.3:
            why = "its node publishes no speed above zero"
            return Finding(False, expected, f"{name} stayed where it was", explanation=why)
        times, x, y = paths[name]
        front_times, front_x, front_y = paths[front]
        gap = np.hypot(np.interp(times, front_times, front_x) - x, np.interp(times, front_times, front_y) - y)
        worst = int(np.argmax(np.abs(gap - GAP)))
        if not NEAREST <= gap.min() <= gap.max() <= FARTHEST:
            measured = f"{called}, {name} was {gap[worst]:.2f} m from {front} at {times[worst]:.1f} s"
            why = "it drives on where the distance is the gap, and should stand there"
            if gap[worst] > GAP:
                why = "it falls behind, or turns another way than to the place of the robot in front"
            return Finding(False, expected, measured, float(times[worst]), explanation=why)
        if abs(gap[-1] - GAP) > AT_REST:
            return Finding(False, expected, f"{called}, {name} ended {gap[-1]:.2f} m from {front}", float(times[-1]))
    return Finding(True, expected, f"{called}, all {len(names)} robots kept together")
