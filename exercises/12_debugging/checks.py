"""Checks of the repaired system: each looks at one fault, in the graph, in the bridge or in the truth."""

import json
import math

import numpy as np

from gz_course.grader.score.check import Finding
from gz_course.grader.score.graphs import bridges
from gz_course.grader.score.launched import deaths, launch_facts

SCAN, COMMANDS = "/scan", "/cmd_vel"
LASER_SCAN, RANGE = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Range"
MOUNT = (-0.2, 0.0, 0.19)  # [m] lidar_link in base_link, as in cart.sdf


def _ends(recording, kind, type=None, topic=None):
    found = recording.facts().get("endpoints", [])
    return [e for e in found if e["kind"] == kind and type in (None, e["type"]) and topic in (None, e["topic"])]


def time_runs(recording, parameters):
    expected = "a simulator that runs from its start, with -r"
    ran = [each for each in launch_facts(recording).get("simulators", []) if each["ran"]]
    if not ran:
        return Finding(False, expected, "no simulator ran")
    if ran[0]["paused"]:
        return Finding(False, expected, "the world was started paused: gz sim had no -r")
    return Finding(recording.ended_s > 0, expected, f"{recording.ended_s:.1f} s were simulated")


def commands_go_to_gazebo(recording, parameters):
    expected = "/cmd_vel -> /model/robot/cmd_vel, ROS_TO_GZ"
    found = [each for each in bridges(recording) if each.gz_topic == "/model/robot/cmd_vel"]
    if not found:
        return Finding(False, expected, "no bridge has the Gazebo topic /model/robot/cmd_vel")
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
        return Finding(False, expected, f"{bridge.place}: the types are {bridge.ros_type} and {bridge.gz_type}")
    return Finding(True, expected, "so it is")


def scans_are_heard(recording, parameters):
    expected = "a subscription to /scan that asks for no more than the bridge offers"
    offers = [each for each in bridges(recording) if each.ros_topic == SCAN and each.publisher_qos is not None]
    if not offers or offers[0].gz_topic != "/lidar/scan" or offers[0].direction != "GZ_TO_ROS":
        return Finding(False, expected, "the bridge does not carry /lidar/scan to /scan, one way")
    takes = _ends(recording, "subscription", LASER_SCAN, SCAN)
    if not takes:
        others = {each["topic"] for each in _ends(recording, "subscription", LASER_SCAN)}
        where = f"; scans are taken from {min(others)}" if others else ""
        return Finding(False, expected, f"no node subscribes to /scan{where}")
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


def same_topic(recording, parameters):
    expected = "the ranger publishes the distance where the driver takes it"
    sends = {each["topic"] for each in _ends(recording, "publisher", RANGE)}
    takes = {each["topic"] for each in _ends(recording, "subscription", RANGE)}
    if not sends:
        return Finding(False, expected, "no node publishes a sensor_msgs/msg/Range")
    if not takes:  # the driver is dead, which another check says: then its topic is the one without a namespace
        right = sends == {"/wall"} and _died(recording, "driver")
        return Finding(right, expected, "so it is" if right else f"nobody takes the distance on {min(sends)}")
    if not sends & takes:
        return Finding(False, expected, f"the distance is published on {min(sends)} and taken from {min(takes)}")
    return Finding(True, expected, f"both use {min(sends & takes)}")


def _died(recording, name):
    said = " ".join(line.text for line in recording.lines("log/student"))
    return f"{name}_node.py" in said and bool(list(deaths(recording)))


def lidar_frame(recording, parameters):
    x, y, z = MOUNT
    expected = f"lidar_link at x = {x}, y = {y}, z = {z} m in base_link"
    for parent, child, sign in (("base_link", "lidar_link", 1), ("lidar_link", "base_link", -1)):
        place = [recording.signal(f"topics/tf_static/{parent}/{child}/translation/{axis}").values for axis in "xyz"]
        if not all(map(len, place)):
            continue
        turn = [recording.signal(f"topics/tf_static/{parent}/{child}/rotation/{axis}").values[-1] for axis in "xyz"]
        seen = [sign * axis[-1] for axis in place]
        if any(abs(each) > 0.01 for each in turn):
            return Finding(False, expected, "the transform turns the lidar, which looks ahead")
        if math.dist(seen, MOUNT) < 0.005:
            return Finding(True, expected, "so it is")
        measured = f"the transform says x = {seen[0]:.2f}, y = {seen[1]:.2f}, z = {seen[2]:.2f} m"
        inverted = math.dist([-each for each in seen], MOUNT) < 0.005
        why = "the transform is inverted: parent and child are swapped" if inverted else ""
        signs = [
            name for name, one, other in zip("xyz", seen, MOUNT, strict=True) if abs(one + other) < 0.005 < abs(one)
        ]
        if signs and not inverted:
            why = f"the sign of {' and '.join(signs)} is wrong"
        return Finding(False, expected, measured, explanation=why)
    return Finding(False, expected, "nobody publishes a static transform between base_link and lidar_link")


def all_alive(recording, parameters):
    expected = "no process of the launch ends before Ctrl-C"
    facts = launch_facts(recording)
    ended = facts.get("ended_early", [])
    if dead := list(deaths(recording)):
        return Finding(False, expected, f"{dead[0].process} ended with exit code {dead[0].code}{dead[0].words}")
    if ended:
        return Finding(False, expected, f"{ended[0]['program']} had ended with exit code {ended[0]['code']}")
    if not _ends(recording, "publisher", topic=COMMANDS):
        return Finding(False, expected, "no node publishes /cmd_vel: the driver never ran")
    if not _ends(recording, "subscription", LASER_SCAN):
        return Finding(False, expected, "no node takes scans: the ranger never ran")
    return Finding(True, expected, "so it is")


def simulated_time(recording, parameters):
    expected = "the ranger and the driver follow /clock"
    follows = {each["node"] for each in _ends(recording, "subscription", topic="/clock")}
    ranger = {each["node"] for each in _ends(recording, "publisher", RANGE)}
    driver = {each["node"] for each in _ends(recording, "subscription", RANGE)} - ranger
    if not ranger:
        return Finding(False, expected, "no node publishes a sensor_msgs/msg/Range")
    for node in sorted(ranger | driver):
        if node not in follows:
            return Finding(False, expected, f"{node} ran without use_sim_time: its clock is that of the computer")
    return Finding(True, expected, "so it is")


def parks(recording, parameters):
    trial = json.loads(recording.properties("run").get("trial_parameters", "{}"))
    wanted, tolerance = float(trial.get("parameters", {}).get("stop_at", 1.0)), parameters["tolerance"]
    expected = f"it stands {wanted:g} m from the wall (+- {tolerance:g} m) in the last second, and touches nothing"
    x, y = (recording.signal(f"truth/robot/{axis}") for axis in "xy")
    wall = recording.poses("world/wall")
    if not len(x) or wall is None:
        return Finding(False, expected, "nothing was simulated")
    if recording.signal("truth/robot/distance").values[-1] < 0.1:
        heard = len(recording.signal("topics/wall/range"))
        why = "" if heard else "the ranger published no distance on /wall: it waits without end, or drops every scan"
        if heard and not len(recording.signal("topics/cmd_vel/count")):
            why = (
                f"the driver got {heard} distances and published no command: one of its callbacks hangs, and waits for "
                "what only another callback of the node could bring"
            )
        return Finding(False, expected, "the cart stood still", explanation=why)
    qx, qy, qz, qw = wall.quaternions[0]
    normal = np.array([1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy + qz * qw)])
    places = np.stack([x.values, y.values], axis=1)
    away = np.abs((places - wall.positions[0][:2]) @ normal) - 0.05
    if away.min() < min(wanted - tolerance, 0.23):
        return Finding(False, expected, f"it came within {away.min():.2f} m of the wall")
    last = away[x.times >= x.times[-1] - 1_000_000_000]
    if x.times[-1] < 8e9:
        return Finding(False, expected, f"the run ended after {x.times[-1] / 1e9:.1f} s")
    worst = last[np.argmax(np.abs(last - wanted))]
    right = abs(worst - wanted) <= tolerance
    why = ""
    if not right and away[-1] > away[0] + 0.5:
        why = "it drives away from the wall: the sign of linear.x is wrong"
    for shift, words in (
        (MOUNT[0], "the distance is measured from the lidar, and is asked for from base_link"),
        (-MOUNT[0], "the place of the lidar on the cart is taken with the wrong sign"),
    ):
        if not right and abs(worst - wanted - shift) <= tolerance:
            why = f"it stands {abs(shift):g} m too {'near' if shift < 0 else 'far'}: {words}"
    return Finding(bool(right), expected, f"it stood {worst:.2f} m from the wall", explanation=why)
