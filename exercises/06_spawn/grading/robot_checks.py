"""Checks that only this exercise needs: the world of the launch, the robot's description, and its joints."""

from __future__ import annotations

from typing import Any

import numpy as np

from gz_course.grader.feedback.predictions.of_robots.driving import leans
from gz_course.grader.feedback.predictions.of_robots.topics import few_joints, no_joint_states, why_not_carried
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.grader.score.graphs import bridges
from gz_course.grader.score.launched import argument, deaths, launch_facts, logged_error, ran
from gz_course.grader.score.robots import Robot, robot_of

TURNED = 1.0  # [rad] by which a wheel turns at least
DRIVEN = 0.3  # [m] on which it does
PUBLISHER = "/robot_state_publisher"


def world_runs(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if the simulator has the world of the argument, and runs."""
    wanted, called = argument(recording, "world", "yard.sdf")
    expected = f"{called}: the world {wanted}, running"
    if not ran(recording):
        return Finding(False, expected, "no simulator ran")
    found = ran(recording)[0]
    if found["world"] != wanted:
        return Finding(False, expected, f"{called} it ran {found['world']}")
    if found["paused"]:
        why = "without -r the simulator starts paused, and no time passes"
        return Finding(False, expected, f"{called} it was paused", explanation=why)
    return Finding(True, expected, f"{called} it ran {found['world']}")


def taken_as_it_is(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if the simulator had nothing to warn of when the robot was created."""
    expected = "no warning of gz sim when the robot is created"
    warnings = launch_facts(recording).get("model_warnings", [])
    robot = robot_of(recording, "scout")
    if not warnings and robot is not None and (tilted := leans(robot)):
        return Finding(False, expected, "there was none, but a wheel leans", explanation=tilted)
    if not warnings:
        return Finding(True, expected, "there was none")
    more = f", and {len(warnings) - 1} more" if len(warnings) > 1 else ""
    why = _in_the_ground(robot) if "ground_plane::" in warnings[0] and "inside each other" in warnings[0] else ""
    return Finding(False, expected, f"gz sim says: {shown(warnings[0], 300)}{more}", explanation=why)


def _in_the_ground(robot: Robot | None) -> str:
    """Return which part of a robot that came in the ground is the lowest, and how high -z must lift it."""
    low = robot.lowest_link() if robot is not None else None
    if low is None or low.lowest >= 0:
        return ""
    return (
        f"it starts inside the ground: its lowest part, {low.lowest_part}, is {-low.lowest:.2f} m below its origin, so "
        "-z of create must be that or more, or the origin must lie lower in the robot"
    )


def described(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if robot_state_publisher offers the description to the end, and follows simulated time."""
    expected = f"{PUBLISHER} with /robot_description and use_sim_time, to the end"
    facts = recording.facts()
    if died := next((each for each in deaths(recording) if each.process == PUBLISHER[1:]), None):
        return Finding(False, expected, f"{PUBLISHER[1:]} ended with exit code {died.code}{died.words}")
    ends = [end for end in facts.get("endpoints", []) if end["node"] == PUBLISHER]
    if not any((end["kind"], end["topic"]) == ("publisher", "/robot_description") for end in ends):
        others = [end for end in facts.get("endpoints", []) if end["topic"].endswith("/robot_description")]
        other = next((end for end in others if end["kind"] == "publisher"), None)
        why = f"{other['node']} publishes {other['topic']}: it has another name, or a namespace" if other else ""
        return Finding(False, expected, f"no node {PUBLISHER} published /robot_description", explanation=why)
    if not any(end["topic"] == "/clock" for end in ends):
        measured = f"{PUBLISHER} ran without use_sim_time: it does not follow /clock"
        return Finding(False, expected, measured, explanation="its transforms get the time of the computer")
    if not any(bridge.ros_topic == "/clock" and bridge.to_ros for bridge in bridges(recording)):
        return Finding(False, expected, "it waits for /clock, which no bridge carries to ROS")
    return Finding(True, expected, "so it was")


def joints_move(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if the states of two joints arrive in ROS all the time, and transforms are made of them."""
    expected = "/joint_states with two wheels or more, and /tf, at least 10 times a second"
    least = 10 * (recording.ended_s - 0.5)
    robot = robot_of(recording, "scout")
    states = len(recording.signal("topics/joint_states/count"))
    if not states:
        if why := why_not_carried(
            bridges(recording),
            "/joint_states",
            "sensor_msgs/msg/JointState",
            to_gz=False,
            said=logged_error(recording, "parameter_bridge"),
            remapped=recording.facts().get("remappings", []),
        ):
            return Finding(False, expected, "no message came on /joint_states", explanation=why)
        bridge = next(bridge for bridge in bridges(recording) if bridge.ros_topic == "/joint_states")
        why = no_joint_states(robot, bridge) if robot is not None else ""
        return Finding(False, expected, f"nothing came on the Gazebo topic {bridge.gz_topic}", explanation=why)
    _, positions = recording.arrays("topics/joint_states/position")
    if not positions or min(map(len, positions)) < 2:
        why = few_joints(robot) if robot is not None else ""
        return Finding(False, expected, "/joint_states holds fewer than two joints", explanation=why)
    if states < least:
        return Finding(False, expected, f"{states} messages came on /joint_states")
    driven = recording.signal("truth/scout/distance").values
    angles = np.array([row for row in positions if len(row) == len(positions[-1])])
    turning = int(np.sum(np.ptp(angles, axis=0) > TURNED))
    if len(driven) and driven[-1] > DRIVEN and turning < 2:
        measured = f"the robot drove {driven[-1]:.2f} m, and {turning} of its joints turned"
        return Finding(False, expected, measured, explanation="it does not drive with its wheels")
    transforms = len(recording.signal("topics/tf/count"))
    if transforms < least:
        return Finding(False, expected, f"{states} messages came on /joint_states, and {transforms} on /tf")
    return Finding(True, expected, f"{states} messages on /joint_states, {transforms} on /tf")
