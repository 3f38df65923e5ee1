"""The parts of a robot that was created, as plain data for the recording: scoring never reads the robot's file.

Places [m], directions and rotations are in the frame of the model. Numbers are rounded to a micrometre, so that equal
robots have equal facts.
"""

from __future__ import annotations

import math
from typing import Any

from gz_course.sim.gz.sim.pose import Pose, matrix, rotated
from gz_course.sim.gz.sim.sdf.description import Collision, Joint, Link, Model, Plugin, Sensor
from gz_course.sim.gz.sim.sdf.element import Element

MOST_ROBOTS = 8
MOST_PARTS = 60  # links of a robot, joints, collisions of a link and so on
LONGEST = 120  # characters of a text
DEEPEST = 5  # levels of elements below a sensor or a plugin


def robot_facts(model: Model) -> dict[str, Any]:
    """Return links, joints, sensors and plugins of a model; those beyond `MOST_PARTS` are left out."""
    sensors = [(sensor, link) for link in model.links for sensor in link.sensors]
    links = {link.name: link for link in model.links}
    return {
        "links": [_link(link) for link in model.links[:MOST_PARTS]],
        "joints": [_joint(joint, links[joint.child]) for joint in model.joints[:MOST_PARTS] if joint.child in links],
        "sensors": [_sensor(sensor, link) for sensor, link in sensors[:MOST_PARTS]],
        "plugins": [_plugin(plugin) for plugin in model.plugins[:MOST_PARTS]],
        "complete": max(len(model.links), len(model.joints), len(model.plugins), len(sensors)) <= MOST_PARTS,
    }


def _link(link: Link) -> dict[str, Any]:
    inertial = link.inertial
    return {
        "name": link.name[:LONGEST],
        "mass": _finite(inertial.mass),
        "centre": _numbers((link.pose * inertial.pose).position),
        "shapes": [_shape(collision, link.pose) for collision in link.collisions[:MOST_PARTS]],
    }


def _shape(collision: Collision, link: Pose) -> dict[str, Any]:
    pose = link * collision.pose
    return {
        "name": collision.name[-LONGEST:],
        "kind": collision.geometry.kind,
        "size": _numbers(collision.geometry.size),
        "position": _numbers(pose.position),
        "rotation": [_numbers(row) for row in matrix(pose.quaternion)],
        "mu": _finite(collision.mu),
    }


def _joint(joint: Joint, child: Link) -> dict[str, Any]:
    frame, axis = child.pose * joint.pose, joint.axis
    made = {
        "name": joint.name[:LONGEST],
        "kind": joint.kind,
        "parent": joint.parent[:LONGEST],
        "child": joint.child[:LONGEST],
        "position": _numbers(frame.position),
    }
    if axis is None:
        return made
    inverse = joint.pose.inverse()
    return made | {
        "axis": _numbers(rotated(child.pose.quaternion.tolist(), axis.direction)),
        "stated_axis": _numbers(rotated(inverse.quaternion.tolist(), axis.direction)),
        "lower": _finite(axis.lower),
        "upper": _finite(axis.upper),
        "effort": _finite(axis.effort),
        "velocity": _finite(axis.velocity),
        "damping": _finite(axis.damping),
        "friction": _finite(axis.friction),
    }


def _sensor(sensor: Sensor, link: Link) -> dict[str, Any]:
    pose = link.pose * sensor.pose
    return {
        "name": sensor.name[:LONGEST],
        "kind": sensor.kind[:LONGEST],
        "link": link.name[:LONGEST],
        "position": _numbers(pose.position),
        "up": _numbers(rotated(pose.quaternion.tolist(), (0.0, 0.0, 1.0))),
        "values": _values(sensor.element),
    }


def _plugin(plugin: Plugin) -> dict[str, Any]:
    values = _values(plugin.element)
    return {"name": plugin.name[:LONGEST], "filename": plugin.filename[:LONGEST], "values": values}


def _values(element: Element) -> list[list[str]]:
    """Return path and text of the elements below, such as `["lidar/range/max", "12"]`, in the order of the file."""
    found: list[list[str]] = []
    waiting = [("", child, 1) for child in reversed(element.children)]
    while waiting and len(found) < MOST_PARTS:
        above, child, depth = waiting.pop()
        path = f"{above}{child.tag}"[:LONGEST]
        if child.text:
            found.append([path, child.text[:LONGEST]])
        if depth < DEEPEST:
            waiting += [(f"{path}/", each, depth + 1) for each in reversed(child.children)]
    return found


def _numbers(values: Any) -> list[float]:
    return [round(float(value), 6) + 0.0 for value in values]


def _finite(value: float) -> float | None:
    """Return a number; None for one that means no limit."""
    return round(float(value), 6) + 0.0 if math.isfinite(value) and abs(value) < 1e15 else None
