"""Warnings about valid SDF that is probably a mistake: degrees for radians, a misplaced size, a wheel without inertia,
a robot without collisions.

Nothing is changed; the world runs as it is written.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator

import numpy as np

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.sdf import tyres
from gz_course.sim.gz.sim.sdf.description import Link, Model
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.inertia import solid, tensor
from gz_course.sim.gz.sim.sdf.materials import warn_of_directions
from gz_course.sim.gz.sim.sdf.vocabulary import known_words

Found = Iterator[tuple[str, str]]
"""Places (`file:line`) and sentences."""

NEWEST_VERSION = (1, 12)
MOST_RADIANS = 6.5
"""Maximum plausible angle [rad] of a pose, just above a full turn; larger ones are probably in degrees."""
DEGREES = frozenset(range(15, 361, 15))
"""Limits of joints that are probably in degrees; other large limits are those of joints with several turns."""
LEAST_INERTIA = 0.05
"""Share of the inertia of a link's largest collision, with its mass evenly spread, below which its own is doubted."""
LARGEST_RATIO = 1e5
"""Ratio of two masses above which the heavier body presses the lighter one into the ground."""
_NEEDED = {
    "box": ("size",),
    "sphere": ("radius",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "cone": ("radius", "length"),
    "ellipsoid": ("radii",),
}
"""The elements that every shape should have, although SDF has defaults for them."""
_NO_TEXT = frozenset((*_NEEDED, *["plane", "mesh", "geometry", "visual", "link", "inertial", "inertia", "axis"]))
_CPU_LIDARS = ("lidar", "ray")
"""Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/SdfEntityCreator.cc"""
_AXIS_NEEDED = frozenset(("revolute", "continuous", "prismatic", "screw"))


def check(root: Element, diagnostics: Diagnostics) -> None:
    """Warn about the elements of an SDF tree, or of a URDF."""
    waiting = [root]
    while waiting:
        element = waiting.pop()
        for where, sentence in _stray_text(element):
            diagnostics.warn(where, sentence)  # the text is ignored by SDF
        for where, sentence in _RULES.get(element.tag, _nothing)(element):
            diagnostics.doubt(where, sentence)
        waiting.extend(child for child in reversed(element.children) if child.tag not in ("plugin", "gui"))


def check_origins(robot: Element, diagnostics: Diagnostics) -> None:
    """Warn about the angles of a URDF; its other elements are checked after the conversion to SDF."""
    for element in (*robot.all("link"), *robot.all("joint")):
        for holder in (element, *element.children):
            for origin in holder.all("origin"):
                for where, sentence in _angles(origin, _numbers(origin.attributes.get("rpy", "")), ""):
                    diagnostics.doubt(where, sentence)


def _stray_text(element: Element) -> Found:
    if element.tag in _NO_TEXT and element.text:
        known = ", ".join(f"<{tag}>" for tag in sorted(known_words().children.get(element.tag, ())))
        yield element.where, f"the text '{element.text}' in <{element.tag}> is ignored; what can stand there is {known}"


def _nothing(element: Element) -> Found:
    return iter(())


def _shape(element: Element) -> Found:
    missing = [tag for tag in _NEEDED[element.tag] if not element.text_of(tag)]
    if missing:
        names = " and no ".join(f"<{tag}>" for tag in missing)
        yield element.where, f"<{element.tag}> has no {names}, so it has the default size; add what is missing"


def _pose(element: Element) -> Found:
    if element.attributes.get("degrees", "false").lower() in ("true", "1"):
        return
    angles = _numbers(element.text)[3:] if element.attributes.get("rotation_format", "euler_rpy") == "euler_rpy" else []
    yield from _angles(element, angles, "; or write <pose degrees='true'>")


def _angles(element: Element, angles: list[float], otherwise: str) -> Found:
    large = [angle for angle in angles if MOST_RADIANS < abs(angle) < math.inf]
    if large:
        text = f"<{element.tag}> turns by {large[0]:g} rad, which is more than once round; angles are in radians: "
        yield element.where, f"{text}{large[0]:g} degrees are {math.radians(large[0]):.4f}{otherwise}"


def _version(element: Element) -> Found:
    version = element.attributes.get("version", "")
    if version and tuple(map(int, version.split("."))) > NEWEST_VERSION:
        newest = ".".join(map(str, NEWEST_VERSION))
        yield (
            element.where,
            f"there is no version {version} of SDF, the file is read as {newest}; write version='{newest}'",
        )


def _colour(element: Element) -> Found:
    numbers = _numbers(element.text)
    if any(2.0 < number <= 255.0 for number in numbers[:3]):
        scaled = " ".join(f"{number / 255.0:.3g}" for number in numbers[:3])
        yield element.where, f"<{element.tag}> is {element.text}, but colours go from 0 to 1; write '{scaled} 1'"


def _joint(element: Element) -> Found:
    kind = element.attributes.get("type", "")
    if kind in _AXIS_NEEDED and element.find("axis") is None and element.text_of("child"):
        text = f"joint '{element.name}' is {kind} and has no <axis>, so it moves about or along z"
        yield element.where, f"{text}; add for example <axis><xyz>0 1 0</xyz></axis>"
    limit = element.find("axis/limit")
    if kind != "revolute" or limit is None:
        return
    stated = [_numbers(limit.text_of(tag)) for tag in ("lower", "upper")]
    values = [value for numbers in stated for value in numbers if value]
    if values and all(abs(value) in DEGREES for value in values):
        text = f"the limits of joint '{element.name}' are {' and '.join(f'{value:g}' for value in values)} rad"
        yield (
            limit.where,
            f"{text}; were degrees meant? {values[-1]:g} degrees are {math.radians(values[-1]):.4f} rad",
        )


def _sensor(element: Element) -> Found:
    rate = element.find("update_rate")
    if rate is not None and any(number < 0.0 for number in _numbers(rate.text)):
        text = f"<update_rate> of sensor '{element.name}' is {rate.text} Hz, so it measures at every step"
        yield rate.where, f"{text}; write how often a second, or 0 for every step"
    kind = element.attributes.get("type", "")
    if kind in _CPU_LIDARS:
        text = f"sensor '{element.name}' is of type {kind}: it works here, but Gazebo says 'Sensor type LIDAR not "
        yield element.where, f"{text}supported yet' and publishes nothing for it; write type='gpu_lidar'"
    for plugin in element.all("plugin"):
        if plugin.name.endswith("ThermalSensor"):  # it has parameters of the sensor
            continue
        shown = plugin.attributes.get("filename") or plugin.name
        text = f"plugin '{shown}' inside of sensor '{element.name}' is ignored with all its parameters"
        if "gazebo_ros" in shown:
            text += ", it is of Gazebo Classic"
        text += "; a system of the world publishes the sensor: <topic> and <gz_frame_id> belong directly into <sensor>"
        yield plugin.where, text


_RULES: dict[str, Callable[[Element], Found]] = {
    **dict.fromkeys(_NEEDED, _shape),
    "pose": _pose,
    **dict.fromkeys(("ambient", "diffuse", "specular", "emissive"), _colour),
    "joint": _joint,
    "sdf": _version,
    "sensor": _sensor,
}


def _numbers(text: str) -> list[float]:
    try:
        return [float(word) for word in text.split()]
    except ValueError:
        return []  # the reader reports this error


def check_model(model: Model, held: bool, diagnostics: Diagnostics) -> None:
    """Warn about a moving model that lacks mass, inertia or collisions; `held`: a joint of the world carries it."""
    honoured = tyres.is_stated(model)
    for part in (part for link in model.links for part in link.collisions):
        warn_of_directions(part.element, part.mu, id(part) in honoured, diagnostics)
    if model.static:
        return
    links = {link.name: link for link in model.links}
    for joint in model.joints:
        link = links.get(joint.child)
        if joint.kind == "fixed" or link is None or not link.collisions:
            continue
        if link.element.find("inertial") is None:
            text = f"link '{link.name}' has no <inertial>, so it has a mass of 1 kg and moments of inertia of 1 kg m^2 "
            text += (
                f"(SDF's default), and joint '{joint.name}' moves slowly; state both or write <inertial auto='true'/>"
            )
            diagnostics.doubt(link.element.where, text)
        elif (stated := _least_moment(tensor(link.inertial.moments))) < LEAST_INERTIA * (usual := _usual_moment(link)):
            text = f"link '{link.name}' has almost no moment of inertia: {stated:.2g} kg m^2, where its mass and shape "
            text += f"make {usual:.2g}; joint '{joint.name}' then has next to nothing to turn, and physics can fail "
            diagnostics.doubt(link.element.where, f"{text}(the robot explodes); state that of its shape in <inertia>")
    joined = {end for joint in model.joints for end in (joint.parent, joint.child)}
    loose = [link for link in model.links if link.name not in joined]
    if model.joints and loose:
        text = f"no <joint> connects link '{loose[0].name}' with the rest of model '{model.name}', so it falls off"
        diagnostics.doubt(loose[0].element.where, f"{text}; add one, for example of type fixed")
    held = held or any(joint.parent == "world" for joint in model.joints)
    seen, solid = (any(getattr(link, parts) for link in model.links) for parts in ("visuals", "collisions"))
    if seen and not solid and not held and any(link.gravity for link in model.links):
        text = f"model '{model.name}' can be seen but has no <collision>, so it falls through the ground; add one, or "
        diagnostics.doubt(model.element.where, f"{text}write <static>true</static>")


def check_masses(models: Iterable[Model], diagnostics: Diagnostics) -> None:
    """Warn if the bodies that can touch each other have masses beyond what contacts can hold."""
    moving = [model for model in models if not model.static and any(link.collisions for link in model.links)]
    if len(moving) < 2:
        return
    light, heavy = min(moving, key=Model.mass), max(moving, key=Model.mass)
    if heavy.mass() > LARGEST_RATIO * light.mass():
        text = f"model '{heavy.name}' of {heavy.mass():.3g} kg is {heavy.mass() / light.mass():.1g} times as heavy as "
        text += f"model '{light.name}' of {light.mass():.3g} kg; if it lies on it, it presses it into the ground; "
        diagnostics.doubt(light.element.where, f"{text}use masses that differ by less than {LARGEST_RATIO:.0e}")


def _usual_moment(link: Link) -> float:
    """Return the smallest principal moment [kg m^2] of the link's mass, evenly spread in its largest collision."""
    solids = [body for collision in link.collisions if (body := solid(collision.geometry)) is not None]
    if not solids:
        return 0.0
    volume, _, inertia = max(solids, key=lambda body: body[0])
    return link.inertial.mass * _least_moment(inertia) / volume


def _least_moment(inertia: np.ndarray) -> float:
    return float(np.linalg.eigvalsh(inertia)[0])
