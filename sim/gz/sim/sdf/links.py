"""`<link>` and what is fixed to it: inertia, collisions, visuals, sensors.

Part of the reader, called once per link with the scope that knows where the model's frames stand.
"""

from __future__ import annotations

import math

import numpy as np

from gz.sim.errors import Diagnostics
from gz.sim.pose import Pose
from gz.sim.sdf.description import Collision, Inertial, Link, Model, Sensor, Visual
from gz.sim.sdf.element import Element
from gz.sim.sdf.frames import Scope
from gz.sim.sdf.geometry import read_colour, read_friction, read_geometry


def read_link(element: Element, scope: Scope, model: Model, diagnostics: Diagnostics) -> Link:
    """Return the link; its pose is in the frame of `model`, the poses of its parts in the link's own
    frame.
    """
    link = Link(element.name, scope.pose_of(element.name, element), element)
    link.gravity = element.flag("gravity", True)
    link.self_collide = element.flag("self_collide", False) or model.self_collide
    inertial = element.find("inertial")
    if inertial is not None:
        link.inertial = _inertial(inertial, _part_pose(inertial, link, scope), model.static)
    names: set[tuple[str, str]] = set()
    for part in element.all("collision", "visual", "sensor"):
        if not part.name:
            raise part.error(f"<{part.tag}> needs a name attribute")
        if (part.tag, part.name) in names:
            raise part.error(f"link '{link.name}' already has a <{part.tag}> called '{part.name}'; names must differ")
        names.add((part.tag, part.name))
        if part.tag == "sensor":
            link.sensors.append(_sensor(part, link, model, scope, diagnostics))
            continue
        geometry = read_geometry(part, diagnostics)
        if geometry is None:
            continue
        pose = _part_pose(part, link, scope)
        if part.tag == "collision":
            bitmask = _bitmask(part)
            density = part.number("density", 1000.0)
            link.collisions.append(Collision(part.name, pose, geometry, part, read_friction(part), bitmask, density))
        else:
            link.visuals.append(Visual(part.name, pose, geometry, part, read_colour(part, diagnostics)))
    return link


def _part_pose(element: Element, link: Link, scope: Scope) -> Pose:
    """Return an element's pose in its link's frame, whatever `relative_to` says."""
    child = element.find("pose")
    if child is None:
        return Pose()
    base = child.attributes.get("relative_to", "") or child.attributes.get("frame", "")
    if not base or base == link.name:
        return child.pose()
    return link.pose.inverse() * scope.pose_of(base, child) * child.pose()


def _inertial(element: Element, pose: Pose, static: bool) -> Inertial:
    mass = element.number("mass", 1.0)
    automatic = element.attributes.get("auto", "false") in ("true", "1")
    if not automatic and not static and not (0.0 < mass < 1e12):
        raise element.error(f"<mass> must be greater than zero, got {element.text_of('mass')}")
    inertia = element.find("inertia")
    values = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]
    if inertia is not None:
        values = [
            inertia.number(tag, default)
            for tag, default in zip(("ixx", "iyy", "izz", "ixy", "ixz", "iyz"), values, strict=True)
        ]
        if not all(map(math.isfinite, values)):
            raise inertia.error("<inertia> must be finite")
        if not automatic and not static:
            _check_inertia(inertia, values)
    ixx, iyy, izz, ixy, ixz, iyz = values
    return Inertial(mass, (ixx, iyy, izz, ixy, ixz, iyz), pose, automatic)


def _check_inertia(element: Element, values: list[float]) -> None:
    ixx, iyy, izz, ixy, ixz, iyz = values
    small, middle, large = np.linalg.eigvalsh(np.array(((ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz))))
    if small <= 0.0:
        raise element.error(
            f"<inertia> is not that of a body: its smallest principal moment is {small:.3g}, not positive"
        )
    if small + middle < large * (1.0 - 1e-3):
        raise element.error(
            "<inertia> is not that of a body: the two smaller principal moments "
            f"({small:.3g} + {middle:.3g}) must add up to at least the largest ({large:.3g})"
        )


def _bitmask(collision: Element) -> int:
    text = collision.text_of("surface/contact/collide_bitmask", "0xFF")
    try:
        return int(text, 0) & 0x7FFFFFFF
    except ValueError:
        raise collision.error(f"<collide_bitmask> must be a whole number such as 0x01, got '{text}'") from None


def _sensor(element: Element, link: Link, model: Model, scope: Scope, diagnostics: Diagnostics) -> Sensor:
    kind = element.attributes.get("type", "")
    if not kind:
        raise element.error(f"<sensor> '{element.name}' needs a type attribute, for example type='gpu_lidar'")
    child = element.find("pose")
    base = child.attributes.get("relative_to", "") if child is not None else ""
    if child is not None and base and base.split("::")[0] not in (*scope.frames, scope.own):
        # gz-sensors falls back to the raw pose here; so the world still runs.
        diagnostics.warn(child.where, f"sensor pose relative_to='{base}' names no frame; the link's frame is used")
        pose = child.pose()
    else:
        pose = _part_pose(element, link, scope)
    return Sensor(element.name, kind, pose, element, link.name, model.name)
