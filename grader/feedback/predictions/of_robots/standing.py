"""Why a robot falls, tips over or is pushed up, as its collisions, its centre of mass and its first height tell."""

from __future__ import annotations

import numpy as np

from gz_course.grader.feedback.predictions.of_robots.creating import odd_mass, too_light
from gz_course.grader.feedback.predictions.of_robots.driving import (
    hangs,
    lies_flat,
    of_one_side,
    wheels_of,
    without_collision,
    wrong_axis,
)
from gz_course.grader.feedback.rules import guarded
from gz_course.grader.score.robots import LEVEL, Robot
from gz_course.grader.score.steps import told

APART = 0.01  # [m] between the ground and what stands on it, or is in it, when a robot comes
FEET = 0.025  # [m] above its lowest point up to which a robot's parts are tried as feet


@guarded("")
def without_collisions(robot: Robot) -> str:
    """Return that nothing of the robot can touch the ground."""
    if any(link.shapes for link in robot.links):
        return ""
    return "no link of it has a <collision>, so it falls through the ground"


@guarded("")
def above_the_ground(robot: Robot, height: float) -> str:
    """Return how far above the ground a robot came whose origin came at `height` [m]."""
    low = robot.lowest_link()
    gap = height + low.lowest if low is not None else 0.0
    if low is None or gap < APART:
        return ""
    return (
        f"it came {told(gap)} m above the ground: the origin of the robot at z {told(height)} m (-z of create), and "
        f"its lowest part, {low.lowest_part}, at z {told(low.lowest)} m of the robot"
    )


@guarded("")
def in_the_ground(robot: Robot, height: float) -> str:
    """Return how deep in the ground a robot came whose origin came at `height` [m]."""
    low = robot.lowest_link()
    depth = -(height + low.lowest) if low is not None else 0.0
    if low is None or depth < APART:
        return ""
    return (
        f"it starts inside the ground: its lowest part, {low.lowest_part}, came {told(depth)} m below it; -z of create "
        f"must be {told(-low.lowest)} m or more, it was {told(height)} m"
    )


@guarded("")
def falls_over(robot: Robot) -> str:
    """Return that the centre of mass is not above the points on which the robot stands."""
    low = robot.lowest_link()
    if low is None:
        return ""
    if said := lies_flat(robot) or without_collision(robot) or hangs(robot):
        return said
    if said := of_one_side(robot):
        return said
    points = np.concatenate([shape.corners() for _, shape in robot.shapes()])
    feet = points[points[:, 2] < low.lowest + FEET]
    touching = points[points[:, 2] < low.lowest + LEVEL]
    centre = robot.centre
    ends = [float(edge) for edge in (feet[:, 0].min(), feet[:, 0].max())]
    if ends[1] - ends[0] < 0.02:  # [m] the wheels alone, one beside the other
        return (
            f"it touches the ground only at x {told(float(touching[:, 0].mean()))} m: nothing carries it in front or "
            f"behind, and its centre of mass is at x {told(float(centre[0]))} m; a caster is missing, or ends too high"
        )
    if not ends[0] <= centre[0] <= ends[1]:
        side = "in front of" if centre[0] > ends[1] else "behind"
        return (
            f"its centre of mass, at x {told(float(centre[0]))} m, is {side} all that it stands on, which is from x "
            f"{told(ends[0])} to {told(ends[1])} m"
        )
    return ""


@guarded("")
def tips_over(robot: Robot) -> str:
    """Return why a robot that stood tips over once its wheels turn."""
    if said := wrong_axis(robot) or odd_mass(robot) or too_light(robot):
        return said
    wheels, low = wheels_of(robot), robot.lowest_link()
    if low is None or not wheels:
        return ""
    points = np.concatenate([shape.corners() for _, shape in robot.shapes()])
    feet = points[points[:, 2] < low.lowest + FEET]
    ahead = min(float(feet[:, 0].max() - robot.centre[0]), float(robot.centre[0] - feet[:, 0].min()))
    height = float(robot.centre[2]) - low.lowest
    if ahead < 0.25 * height:
        return (
            f"its centre of mass is {told(height)} m above the ground and only {told(max(0.0, ahead))} m from the edge "
            "of what it stands on: lower it, or move it away from the edge"
        )
    return ""
