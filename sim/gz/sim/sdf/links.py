"""Reads `<link>` and its parts: inertia, collisions, visuals, sensors and lights.

Called once for each link, with the scope that resolves the frames of its model.

Source: SDFormat, element `<link>`, http://sdformat.org/spec?elem=link
"""

from __future__ import annotations

import numpy as np

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.description import Collision, Link, Model, Visual
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.frames import Scope
from gz_course.sim.gz.sim.sdf.geometry import read_geometry
from gz_course.sim.gz.sim.sdf.inertia import (
    WATER,
    automatic_inertial,
    is_automatic,
    read_inertial,
    tell_what_gazebo_refuses,
)
from gz_course.sim.gz.sim.sdf.lights import read_light
from gz_course.sim.gz.sim.sdf.materials import (
    read_albedo,
    read_bitmask,
    read_colour,
    read_friction,
    read_restitution,
)
from gz_course.sim.gz.sim.sdf.resources import Resources
from gz_course.sim.gz.sim.sdf.sensors import part_pose, read_sensor


def read_link(element: Element, scope: Scope, model: Model, diagnostics: Diagnostics, resources: Resources) -> Link:
    """Return the link; its pose is in the frame of `model`, the poses of its parts are in the frame of the link."""
    link = Link(element.name, scope.pose_of(element.name, element), element, static=model.static)
    link.gravity = element.flag("gravity", True)
    link.self_collide = element.flag("self_collide", False) or model.self_collide
    names: set[tuple[str, str]] = set()
    for part in element.all("collision", "visual", "sensor", "light"):
        if not part.name:
            raise part.error(f"<{part.tag}> needs a name attribute")
        if (part.tag, part.name) in names:
            raise part.error(f"link '{link.name}' already has a <{part.tag}> called '{part.name}'; names must differ")
        names.add((part.tag, part.name))
        if part.tag == "sensor":
            link.sensors.append(read_sensor(part, link.name, model, scope, diagnostics))
        elif part.tag == "light":
            link.lights.append(read_light(part, part_pose(part, link.name, scope), diagnostics))
        else:
            _add_shape(part, link, model, scope, diagnostics, resources)
    inertial = element.find("inertial")
    if inertial is not None:
        pose = part_pose(inertial, link.name, scope)
        if is_automatic(inertial) and not model.static:
            link.inertial = automatic_inertial(inertial, link.collisions, diagnostics)
        elif not is_automatic(inertial):
            link.inertial = read_inertial(inertial, pose, model.static)
            tell_what_gazebo_refuses(inertial, link, diagnostics)
    _warn_of_unsupported(element, model, diagnostics)
    return link


def _add_shape(
    part: Element, link: Link, model: Model, scope: Scope, diagnostics: Diagnostics, resources: Resources
) -> None:
    geometry = read_geometry(part, not model.static, diagnostics, resources)
    if geometry is None:
        return
    pose = part_pose(part, link.name, scope)
    position = part.find("geometry/heightmap/pos")
    if geometry.kind == "heightmap" and position is not None and position.text:
        pose = pose * Pose(position.floats(3))
    if not np.max(np.abs(pose.position)) < 1e9:
        raise part.error(f"<{part.tag}> '{part.name}' stands more than 1e9 m away from its link")
    if part.tag == "collision":
        friction = read_friction(part, diagnostics)
        density = part.number("density", WATER)
        surface = (friction, read_bitmask(part), density, read_restitution(part))
        link.collisions.append(Collision(part.name, pose, geometry, part, *surface))
    else:
        colour, texture = read_colour(part, diagnostics), read_albedo(part, diagnostics, resources)
        link.visuals.append(Visual(part.name, pose, geometry, part, colour, texture))


def _warn_of_unsupported(element: Element, model: Model, diagnostics: Diagnostics) -> None:
    """Warn about each element of a link that is not simulated."""
    kinematic = element.find("kinematic")
    if kinematic is not None and element.flag("kinematic", False) and not model.static:
        diagnostics.warn(kinematic.where, f"link '{element.name}' is not held kinematic, forces move it; use <static>")
    if element.find("inertial/fluid_added_mass") is not None:
        diagnostics.warn(
            element.where, f"<fluid_added_mass> of link '{element.name}' is ignored; use the Hydrodynamics system"
        )
    decay = element.find("velocity_decay")
    if decay is not None and (decay.number("linear", 0.0) or decay.number("angular", 0.0)):
        diagnostics.warn(
            decay.where, f"<velocity_decay> of link '{element.name}' is ignored: nothing slows it down in air"
        )
    for part in element.all("projector", "audio_source", "audio_sink", "battery", "particle_emitter"):
        text = f"<{part.tag}> is not simulated here, it is left out of link '{element.name}'"
        diagnostics.warn(part.where, text)
