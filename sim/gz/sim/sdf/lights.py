"""Reads `<light>`: directional, point and spot lights of the world or of a link.

Ray-casting cameras, the scene message and MuJoCo's renderer use them.

Source: SDFormat, element `<light>`, http://sdformat.org/spec
"""

from __future__ import annotations

import math

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.description import Light
from gz_course.sim.gz.sim.sdf.element import Element

KINDS = ("directional", "point", "spot")


def read_light(element: Element, pose: Pose, diagnostics: Diagnostics) -> Light:
    """Return a light at `pose`; an unknown type becomes a point light, with a warning."""
    if not element.name:
        raise element.error("<light> needs a name attribute")
    kind = element.attributes.get("type", "point")
    if kind not in KINDS:
        hint = did_you_mean(kind, KINDS, listing="known names are")
        text = f"light '{element.name}' has type '{kind}', a point light is used{hint}"
        diagnostics.warn(element.where, text)
        kind = "point"
    light = Light(element.name, kind, pose, _direction(element), read_rgb(element, "diffuse", (1.0, 1.0, 1.0)))
    light.element = element
    light.specular = read_rgb(element, "specular", (0.1, 0.1, 0.1))
    light.intensity = _bounded(element, "intensity", 1.0)
    light.cast_shadows = element.flag("cast_shadows", False)
    light.on = element.flag("light_on", True)
    light.visualize = element.flag("visualize", True)
    attenuation = element.find("attenuation")
    if attenuation is not None:
        light.range = _bounded(attenuation, "range", 10.0)
        light.constant = _factor(attenuation, "constant", 1.0, diagnostics)
        light.linear = _factor(attenuation, "linear", 1.0, diagnostics)
        light.quadratic = _factor(attenuation, "quadratic", 0.0, diagnostics)
    spot = element.find("spot")
    if spot is not None:
        light.inner_angle = _bounded(spot, "inner_angle", 0.0)
        light.outer_angle = _bounded(spot, "outer_angle", 0.0)
        light.falloff = _bounded(spot, "falloff", 0.0)
    return light


def _direction(element: Element) -> tuple[float, float, float]:
    x, y, z = element.vector("direction", (0.0, 0.0, -1.0))
    length = math.hypot(x, y, z)
    if not 1e-12 < length < math.inf:
        raise (element.find("direction") or element).error("<direction> has no length; use for example 0 0 -1")
    return x / length, y / length, z / length


def _factor(element: Element, tag: str, default: float, diagnostics: Diagnostics) -> float:
    """Return a factor of the attenuation; as in libsdformat one below zero is zero."""
    value = element.number(tag, default)
    if value < 0.0:
        where = (element.find(tag) or element).where
        diagnostics.warn(where, f"<{tag}> is {value:g}, but an attenuation must not be negative; it is 0")
    return min(max(value, 0.0), 1e9)


def _bounded(element: Element, tag: str, default: float) -> float:
    value = element.number(tag, default)
    if value < 0.0:
        raise (element.find(tag) or element).error(f"<{tag}> must not be negative, got {value:g}")
    return min(value, 1e9)


def read_rgb(element: Element, tag: str, default: tuple[float, float, float]) -> tuple[float, float, float]:
    """Return the colour in child `tag`, without alpha, values 0..1."""
    child = element.find(tag)
    if child is None or not child.text:
        return default
    red, green, blue = child.floats(4 if len(child.text.split()) == 4 else 3)[:3]
    return min(1.0, max(0.0, red)), min(1.0, max(0.0, green)), min(1.0, max(0.0, blue))
