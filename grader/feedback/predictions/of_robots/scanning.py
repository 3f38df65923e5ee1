"""Why the scans of a robot's lidar are missing or wrong, as its sensor and the bridges tell."""

from __future__ import annotations

import math

import numpy as np

from gz_course.grader.feedback.predictions.of_robots.topics import heard_elsewhere, topic_of
from gz_course.grader.feedback.rules import guarded
from gz_course.grader.score.graphs import Bridged
from gz_course.grader.score.robots import Robot, Sensor
from gz_course.grader.score.steps import told

HOUSING = 0.15  # [m] across
LIDARS = ("gpu_lidar", "lidar", "ray", "gpu_ray")
HORIZONTAL = ("lidar/scan/horizontal", "ray/scan/horizontal")


def lidars(robot: Robot) -> list[Sensor]:
    return [sensor for sensor in robot.sensors if sensor.kind in LIDARS]


@guarded("")
def of_gazebo_classic(robot: Robot) -> str:
    """Return that all lidars have a type that Gazebo reads and does not simulate.

    Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/SdfEntityCreator.cc
    """
    found = lidars(robot)
    if not found or any(sensor.kind.startswith("gpu_") for sensor in found):
        return ""
    return (
        f"the sensor {found[0].name} is of type {found[0].kind}, which Gazebo Classic had: the present Gazebo "
        'publishes nothing for it (Sensor type LIDAR not supported yet); write type="gpu_lidar", and <lidar> in it'
    )


@guarded("")
def no_scan(robot: Robot, bridge: Bridged) -> str:
    """Return why nothing publishes on the Gazebo topic of a bridge."""
    found = lidars(robot)
    if not found:
        others = ", ".join(f"{sensor.name} (type {sensor.kind})" for sensor in robot.sensors) or "none at all"
        return (
            f"the robot has no sensor of type gpu_lidar; its sensors are: {others}. A <sensor> stands in <gazebo "
            'reference="LINK">, with the name of a link'
        )
    topics = [topic_of(sensor.text("topic"), "") for sensor in found]
    if bridge.gz_topic not in topics and topics[0]:
        return heard_elsewhere("the lidar publishes on", topics[0], bridge)
    if not topics[0]:
        return f"{bridge.place}: the lidar has no <topic>, so it does not publish on {bridge.gz_topic}"
    return ""


@guarded("")
def few_scans(robot: Robot, least: float) -> str:
    """Return that the lidar is slower than `least` [Hz]."""
    for sensor in lidars(robot):
        rate = sensor.number("update_rate", 0.0)
        if 0 < rate < least:
            return f"<update_rate> of the lidar is {rate:g} Hz, and it is how often a second it measures"
    return ""


@guarded("")
def narrow(robot: Robot, turn: float) -> str:
    """Return which of the lidar's angles or samples make it see less than `turn` [rad]."""
    for sensor in lidars(robot):
        for base in HORIZONTAL:
            if not sensor.text(f"{base}/samples") and not sensor.text(f"{base}/max_angle"):
                continue
            low, high = (sensor.number(f"{base}/{end}_angle", 0.0) for end in ("min", "max"))
            samples = sensor.number(f"{base}/samples", 640)
            if high - low < turn:
                half = (
                    ", which is half a turn: pi to either side is all around" if abs(high - low - math.pi) < 0.1 else ""
                )
                default = "" if sensor.text(f"{base}/min_angle") else " (its default)"
                return (
                    f"the lidar sees from <min_angle> {low:g}{default} to <max_angle> {high:g} rad{half}; all around "
                    "is from -3.14159 to 3.14159"
                )
            if high - low > 2.1 * math.pi:
                return (
                    f"<min_angle> {low:g} and <max_angle> {high:g} are in radians, and more than once around: "
                    "-180 and 180 degrees are -3.14159 and 3.14159"
                )
            return f"<samples> of the lidar is {samples:g}"
    return ""


@guarded("")
def other_frame(robot: Robot, frame: str, given: str) -> str:
    """Return that the lidar states the frame `given`."""
    if any(sensor.text("gz_frame_id") == given for sensor in lidars(robot)):
        return f"<gz_frame_id> of the lidar is {given}, and the name of its link is asked for, {frame}"
    return ""


@guarded("")
def range_of(robot: Robot) -> str:
    for sensor in lidars(robot):
        for base in ("lidar/range", "ray/range"):
            if sensor.text(f"{base}/max"):
                return f"<max> in the <range> of the lidar is {sensor.text(f'{base}/max')} m"
    return ""


@guarded("")
def tilted(robot: Robot) -> str:
    """Return by how much the lidar is tilted."""
    for sensor in lidars(robot):
        tilt = math.degrees(math.acos(max(-1.0, min(1.0, float(sensor.up[2])))))
        if 3.0 < tilt < 177.0:
            return f"the lidar is tilted by {tilt:.0f} degrees, so its rays go into the ground and into the air"
    return ""


@guarded("")
def enclosed(robot: Robot) -> str:
    """Return which part of the robot the lidar is inside of; its own housing is smaller than `HOUSING`."""
    for sensor in lidars(robot):
        for link, shape in robot.shapes():
            if shape.kind not in ("box", "cylinder") or float(np.sort(shape.size)[1]) < HOUSING:
                continue
            place = (sensor.position - shape.position) @ shape.rotation
            if np.all(np.abs(place) < shape.size / 2):
                return (
                    f"the lidar is inside of {shape.part or link.name}: a sensor stands at the origin of the link that "
                    '<gazebo reference="LINK"> names, and that is in the body here'
                )
    return ""


@guarded("")
def height_and_tilt(robot: Robot, height: float) -> str:
    """Return how the lidar is tilted, or how high above the ground it is; `height` [m] is that of the robot."""
    if said := tilted(robot):
        return said
    for sensor in lidars(robot):
        return f"its height is {told(height + float(sensor.position[2]))} m above the ground"
    return ""
