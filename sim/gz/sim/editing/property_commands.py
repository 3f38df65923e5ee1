"""The commands of UserCommands that change lights, colours, collisions, physics and spherical coordinates.

Each command reads a message, in any thread, and returns the function that changes the world between two steps. Both
raise SimError with one sentence.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.editing.entity_commands import Command, light_changes, name_of, place_on_planet, pose_of
from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.sdf.description import Collision, Visual
from gz_course.sim.gz.sim.spherical_coordinates import SURFACES, SphericalCoordinates

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess


def commands() -> dict[str, tuple[type, Command]]:
    """Return the services of this file: name -> (request type, command)."""
    from gz_course.sim.gz.msgs.entity_pb2 import Entity
    from gz_course.sim.gz.msgs.light_pb2 import Light
    from gz_course.sim.gz.msgs.physics_pb2 import Physics
    from gz_course.sim.gz.msgs.spherical_coordinates_pb2 import SphericalCoordinates as SphericalMessage
    from gz_course.sim.gz.msgs.visual_pb2 import Visual as VisualMessage
    from gz_course.sim.gz.msgs.wheel_slip_parameters_cmd_pb2 import WheelSlipParametersCmd

    return {
        "light_config": (Light, light_config),
        "visual_config": (VisualMessage, visual_config),
        "set_physics": (Physics, set_physics),
        "set_spherical_coordinates": (SphericalMessage, set_spherical_coordinates),
        "enable_collision": (Entity, lambda world, message: _collide(world, message, True)),
        "disable_collision": (Entity, lambda world, message: _collide(world, message, False)),
        "wheel_slip": (WheelSlipParametersCmd, wheel_slip),
    }


def light_config(world: WorldAccess, message: Any) -> Callable[[], None]:
    """Change the light of the world that a gz.msgs.Light names."""
    if not message.id and not message.name:
        raise SimError("the request names no light: set name, or id")
    changes = light_changes(message)
    if message.HasField("direction"):
        x, y, z = message.direction.x, message.direction.y, message.direction.z
        length = math.sqrt(x * x + y * y + z * z)
        if not (0.0 < length < math.inf):
            raise SimError(f"the direction of a light must be finite and not zero, got {x} {y} {z}")
        changes["direction"] = (x / length, y / length, z / length)
    if message.HasField("pose"):
        changes["pose"] = pose_of(message.pose, message.name)
    return lambda: world.editor.set_light(name_of(world, message.id, message.name, "light"), **changes)


def visual_config(world: WorldAccess, message: Any) -> Callable[[], None]:
    """Set the colour of a visual from the material of a gz.msgs.Visual."""
    if not message.HasField("material"):
        raise SimError("visual_config changes the material only, and the request has none")
    return _paint(world, message.id, message.parent_name, message.name, message.material, message.transparency)


def material_color(world: WorldAccess, message: Any) -> Callable[[], None]:
    """Set the colours of the visuals selected by a gz.msgs.MaterialColor."""
    if not message.entity.name and not message.entity.id:
        raise SimError("the message names no visual: set entity: {name: ...}")
    every = message.entity_match == message.ALL
    return _paint(world, message.entity.id, "", message.entity.name, message, 0.0, every=every)


def _paint(
    world: WorldAccess, number: int, parent: str, name: str, colours: Any, transparency: float, *, every: bool = False
) -> Callable[[], None]:
    colour = colours.diffuse if colours.HasField("diffuse") else colours.ambient
    alpha = (colour.a or 1.0) * (1.0 - transparency)
    parts = [colour.r, colour.g, colour.b, alpha]
    if not all(map(math.isfinite, parts)):
        raise SimError("a colour must be finite")
    r, g, b, a = (min(max(float(part), 0.0), 1.0) for part in parts)

    def work() -> None:
        found = _visuals(world, number, parent, name)
        for visual in found if every else found[:1]:
            world.editor.set_colour(visual, (r, g, b, a))

    return work


def _visuals(world: WorldAccess, number: int, parent: str, name: str) -> list[Visual]:
    path: tuple[str, ...] = ()
    if number:
        entity = world.entities.find(number)
        if entity is None or entity.kind != "visual":
            raise SimError(f"entity {number} is no visual of world '{world.name}'")
        path = entity.path
    known: list[str] = []
    found: list[Visual] = []
    for model in world.description.models:
        for link in model.links:
            for visual in link.visuals:
                known.append(visual.name)
                scoped = (visual.name, f"{link.name}::{visual.name}", f"{model.name}::{link.name}::{visual.name}")
                if path == (model.name, link.name, visual.name) or (
                    not path and name in scoped and parent in ("", link.name, f"{model.name}::{link.name}")
                ):
                    found.append(visual)
    if not found:
        hint = did_you_mean(name, known, listing="known names are")
        raise SimError(f"world '{world.name}' has no visual '{name}'{hint}")
    return found


def _collide(world: WorldAccess, message: Any, enabled: bool) -> Callable[[], None]:
    """Enable or disable the collision of a gz.msgs.Entity, or all collisions of its link or model."""
    if not message.id and not message.name:
        raise SimError("the request names no entity: set id, or name (model, model::link or model::link::collision)")

    def work() -> None:
        path = name_of(world, message.id, message.name)
        found = [collision for name, collision in _collisions(world) if f"{name}::".startswith(f"{path}::")]
        if not found:
            names = [name for name, _ in _collisions(world)]
            hint = did_you_mean(path, names, listing="known names are")
            raise SimError(f"world '{world.name}' has no collision '{path}'{hint}")
        world.editor.enable_collisions(found, enabled)

    return work


def _collisions(world: WorldAccess) -> list[tuple[str, Collision]]:
    return [
        (f"{model.name}::{link.name}::{collision.name}", collision)
        for model in world.description.models
        for link in model.links
        for collision in link.collisions
    ]


def set_physics(world: WorldAccess, message: Any) -> Callable[[], None]:
    """Set the step size and the real-time factor of a gz.msgs.Physics.

    A value of zero changes nothing; as in Gazebo the other fields are ignored.
    """
    step, factor = message.max_step_size or None, message.real_time_factor or None
    return lambda: world.editor.set_physics(step_size=step, real_time_factor=factor)


def set_spherical_coordinates(world: WorldAccess, message: Any) -> Callable[[], None]:
    """Set the spherical coordinates of the world, or move the entity named in the message to these coordinates."""
    numbers = (message.latitude_deg, message.longitude_deg, message.elevation, message.heading_deg)
    if not all(map(math.isfinite, numbers)):
        raise SimError("latitude, longitude, elevation and heading must be finite")
    if message.HasField("entity") and (message.entity.id or message.entity.name):

        def move() -> None:
            name = name_of(world, message.entity.id, message.entity.name)
            world.editor.set_pose(name, place_on_planet(world, message, None))

        return move
    surface = message.SurfaceModel.Name(message.surface_model) if message.surface_model in (0, 1, 2) else ""
    if surface not in SURFACES:
        hint = did_you_mean(surface, SURFACES, listing="known names are")
        raise SimError(f"surface model {message.surface_model} is not known{hint}")
    axes = SURFACES[surface]
    if surface == "CUSTOM_SURFACE":
        axes = (message.surface_axis_equatorial, message.surface_axis_polar)
        if not all(0.0 < axis < math.inf for axis in axes):
            raise SimError("a CUSTOM_SURFACE needs surface_axis_equatorial and surface_axis_polar above zero")
    made = SphericalCoordinates(surface, *numbers, *axes)
    return lambda: world.editor.set_spherical_coordinates(made)


def wheel_slip(world: WorldAccess, message: Any) -> Callable[[], None]:
    """Raise SimError: wheel slip is not simulated."""
    raise SimError("wheel slip is not simulated here, so it cannot be set")
