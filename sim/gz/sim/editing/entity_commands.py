"""The commands of UserCommands that create, remove and move models and lights.

Each command reads a message, in any thread, and returns the function that changes the world between two steps. Both
raise SimError with one sentence. Poses are in the world frame, or in the frame of the model that `relative_to` names.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.description import Light, Model
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.reader import read_model
from gz_course.sim.gz.sim.sdf.writer import pose_element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

Command = Callable[["WorldAccess", Any], Callable[[], None]]
"""A command: reads a message and returns the function to run between two steps."""
_LIGHT_KINDS = ("point", "spot", "directional")


def commands() -> dict[str, tuple[type, Command]]:
    """Return the services of this file: name -> (request type, command)."""
    from gz_course.sim.gz.msgs.entity_factory_pb2 import EntityFactory
    from gz_course.sim.gz.msgs.entity_factory_v_pb2 import EntityFactory_V
    from gz_course.sim.gz.msgs.entity_pb2 import Entity
    from gz_course.sim.gz.msgs.pose_pb2 import Pose as PoseMessage
    from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V

    return {
        "create": (EntityFactory, create),
        "create_multiple": (EntityFactory_V, create_multiple),
        "remove": (Entity, remove),
        "set_pose": (PoseMessage, set_pose),
        "set_pose_vector": (Pose_V, set_pose_vector),
    }


def pose_of(message: Any, about: str) -> Pose:
    """Return the pose in a gz.msgs.Pose; a missing quaternion means no rotation.

    Raises SimError for numbers that are not finite.
    """
    position = (message.position.x, message.position.y, message.position.z)
    turn = message.orientation
    quaternion = np.array((turn.w, turn.x, turn.y, turn.z))
    if not (all(map(math.isfinite, position)) and np.all(np.isfinite(quaternion))):
        raise SimError(f"the pose for '{about}' is not finite, so it is refused; check for division by zero")
    largest = float(np.max(np.abs(quaternion)))
    if not largest > 1e-9:
        return Pose(position)
    quaternion /= largest  # avoids overflow of the squares
    return Pose(position, quaternion / np.linalg.norm(quaternion))


def create(world: WorldAccess, message: Any) -> Callable[[], None]:
    """Read a gz.msgs.EntityFactory; the returned function creates the entity."""
    source = message.WhichOneof("from")
    about = message.name or source or ""
    pose = pose_of(message.pose, about) if message.HasField("pose") else None
    renaming = message.allow_renaming
    made: Model | Light | None = None
    if source == "sdf":
        made = read_model(message.sdf, "<create>", world.diagnostics, message.name, world.resources)
    elif source == "sdf_filename":
        path = world.resources.find_model(message.sdf_filename, None)
        text = world.resources.read_text(path)
        made = read_model(text, str(path), world.diagnostics, message.name, world.resources)
    elif source == "light":
        made = _light(message.light, message.name)
    elif source == "clone_name":
        renaming = renaming or not message.name
    elif source == "model":
        raise SimError("a model can only be created from sdf, sdf_filename or clone_name, not from a model message")
    else:
        raise SimError("there is nothing to create: set sdf, sdf_filename, light or clone_name")

    def work() -> None:
        brought = _clone(world, message.clone_name) if made is None else made
        place = pose if pose is not None else (brought.pose if message.relative_to else None)
        if message.HasField("spherical_coordinates"):
            place = place_on_planet(world, message.spherical_coordinates, place)
        elif message.relative_to and message.relative_to != "world":
            assert place is not None
            place = world.truth.pose(message.relative_to) * place
        world.editor.spawn(brought, name=message.name, pose=place, allow_renaming=renaming)

    return work


def create_multiple(world: WorldAccess, message: Any) -> Callable[[], None]:
    """Create the entities of a gz.msgs.EntityFactory_V; a failure of one does not prevent the others."""
    return _together([create(world, each) for each in message.data])


def remove(world: WorldAccess, message: Any) -> Callable[[], None]:
    """Remove the model or light that a gz.msgs.Entity names by id or name."""
    kinds = {message.MODEL: "model", message.LIGHT: "light", message.NONE: ""}
    if not message.id and not message.name:
        raise SimError("the request names no entity: set name and type (MODEL or LIGHT), or id")
    if message.type not in kinds:
        raise SimError("only models and lights can be removed; set type to MODEL or LIGHT")

    def work() -> None:
        world.editor.remove(name_of(world, message.id, message.name, kinds[message.type]))

    return work


def set_pose(world: WorldAccess, message: Any) -> Callable[[], None]:
    """Move the model, light or floating link that a gz.msgs.Pose names by id or name."""
    if not message.id and not message.name:
        raise SimError("the request names no entity: set name, or id")
    pose = pose_of(message, message.name or f"entity {message.id}")
    return lambda: world.editor.set_pose(name_of(world, message.id, message.name), pose)


def set_pose_vector(world: WorldAccess, message: Any) -> Callable[[], None]:
    """Move the entities of a gz.msgs.Pose_V."""
    return _together([set_pose(world, each) for each in message.pose])


def name_of(world: WorldAccess, number: int, name: str, kind: str = "") -> str:
    """Return the name of an entity given by id or name: `model`, `model::link`, or that of a light.

    Raises SimError if it does not exist or is of another kind.
    """
    if not number:
        if kind and not world.entities.number(kind, name):
            known = [each.path[0] for each in world.entities if each.kind == kind and len(each.path) == 1]
            hint = did_you_mean(name, known, listing="known names are")
            raise SimError(f"world '{world.name}' has no {kind} '{name}'{hint}")
        return name
    entity = world.entities.find(number)
    if entity is None:
        raise SimError(f"world '{world.name}' has no entity {number}")
    if kind and entity.kind != kind:
        raise SimError(f"entity {number} is the {entity.kind} '{entity.name}', not a {kind}")
    return "::".join(entity.path)


def _together(works: list[Callable[[], None]]) -> Callable[[], None]:
    def work() -> None:
        errors: list[str] = []
        for each in works:
            try:
                each()
            except SimError as error:
                errors.append(str(error))
        if errors:
            raise SimError("; ".join(errors))

    return work


def _clone(world: WorldAccess, name: str) -> Model | Light:
    light = next((each for each in world.description.lights if each.name == name), None)
    if light is not None:
        return copy.deepcopy(light)
    pose = world.truth.pose(name)
    model = next(each for each in world.description.models if each.name == name)
    made = copy.deepcopy(model)
    made.pose = pose
    return made


def _light(message: Any, name: str) -> Light:
    if message.type not in range(len(_LIGHT_KINDS)):
        raise SimError(f"light type {message.type} is not known; use POINT, SPOT or DIRECTIONAL")
    kind, called = _LIGHT_KINDS[message.type], name or message.name
    if not called:
        raise SimError("a light needs a name")
    pose = pose_of(message.pose, called)
    element = Element("light", {"name": called, "type": kind}, file="<create>", line=1)
    element.children.append(pose_element(pose, (1, 10)))
    direction = np.array((message.direction.x, message.direction.y, message.direction.z))
    length = float(np.linalg.norm(direction))
    if not math.isfinite(length):
        raise SimError(f"the direction of light '{called}' is not finite, so it is refused")
    x, y, z = (direction / length).tolist() if length > 0.0 else (0.0, 0.0, -1.0)
    light = Light(called, kind, pose, (x, y, z), (1.0, 1.0, 1.0), element=element)
    for attribute, value in light_changes(message).items():
        setattr(light, attribute, value)
    return light


def light_changes(message: Any) -> dict[str, Any]:
    """Return the changes in a gz.msgs.Light as attributes of `description.Light`.

    Unset fields change nothing, except booleans, because proto3 does not distinguish unset from false.
    """
    changes: dict[str, Any] = {"on": not message.is_light_off, "cast_shadows": message.cast_shadows}
    for attribute, field in (
        ("intensity", "intensity"),
        ("range", "range"),
        ("constant", "attenuation_constant"),
        ("linear", "attenuation_linear"),
        ("quadratic", "attenuation_quadratic"),
        ("inner_angle", "spot_inner_angle"),
        ("outer_angle", "spot_outer_angle"),
        ("falloff", "spot_falloff"),
    ):
        value = float(getattr(message, field))
        if not math.isfinite(value) or value < 0.0:
            raise SimError(f"{field} of a light must be zero or more, got {value}")
        if value:
            changes[attribute] = value
    for attribute in ("diffuse", "specular"):
        if message.HasField(attribute):
            colour = getattr(message, attribute)
            changes[attribute] = tuple(min(max(float(part), 0.0), 1.0) for part in (colour.r, colour.g, colour.b))
    return changes


def place_on_planet(world: WorldAccess, where: Any, pose: Pose | None) -> Pose:
    """Return the world pose of a gz.msgs.SphericalCoordinates; its heading is combined with the orientation of `pose`.

    Raises SimError if the world has no spherical coordinates.
    """
    coordinates = world.description.spherical_coordinates
    if coordinates is None:
        raise SimError(f"world '{world.name}' has no <spherical_coordinates>, so it has no latitude and longitude")
    numbers = (where.latitude_deg, where.longitude_deg, where.elevation, where.heading_deg)
    if not all(map(math.isfinite, numbers)):
        raise SimError("latitude, longitude, elevation and heading must be finite")
    position = coordinates.local(*numbers[:3])
    turned = Pose.from_rpy((0.0, 0.0, 0.0), (0.0, 0.0, math.radians(where.heading_deg)))
    return Pose(position, (turned * pose).quaternion if pose is not None else turned.quaternion)
