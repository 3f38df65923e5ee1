"""Converts a world to Gazebo's entities and components, gz.msgs.SerializedStateMap, for `/world/W/state`.

A component's type is the 64-bit FNV-1a hash of its registered name (`gz_sim_components.Pose`). Its bytes are those of
Gazebo's serializers: text for names, numbers and poses (x y z roll pitch yaw), a serialized message for shapes, lights
and inertia, nothing for tags. Velocities and the private components of Gazebo's systems are not included.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/include/gz/sim/components/Factory.hh
Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/include/gz/sim/components/Serialization.hh
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from gz_course.sim.gz.msgs.serialized_map_pb2 import SerializedStateMap
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.scene.fields import set_stamp
from gz_course.sim.gz.sim.scene.graph import SceneGraph, Vertex
from gz_course.sim.gz.sim.scene.message import scene_message
from gz_course.sim.gz.sim.sdf.description import Model

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

JOINT_TYPES = (
    "invalid",
    "ball",
    "continuous",
    "fixed",
    "gearbox",
    "prismatic",
    "revolute",
    "revolute2",
    "screw",
    "universal",
)
"""The kinds of joints; the index is the number in the component JointType."""

Components = Iterator[tuple[str, bytes]]


def fnv_1a(text: str) -> int:
    """Return the 64-bit FNV-1a hash of a text.

    Source: http://www.isthe.com/chongo/tech/comp/fnv (Fowler, Noll, Vo)
    """
    number = 0xCBF29CE484222325
    for byte in text.encode():
        number = ((number ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return number


@functools.cache
def component_type(name: str) -> int:
    """Return the type id of Gazebo's component `name`, for example `Pose`."""
    return fnv_1a(f"gz_sim_components.{name}")


def full_state(world: WorldAccess, graph: SceneGraph) -> SerializedStateMap:
    """Return all entities of the world with their present components."""
    message = SerializedStateMap(has_one_time_component_changes=True)
    set_stamp(message.header, world.sim_time_ns)
    parts = _parts_by_number(scene_message(world, graph))
    for vertex in (graph.root, *graph):
        for name, data in _components(vertex, parts.get(vertex.number), world):
            _put(message, vertex.number, name, data)
    return message


def pose_state(world: WorldAccess, graph: SceneGraph) -> SerializedStateMap:
    """Return the present poses of the entities that can move."""
    message = SerializedStateMap()
    set_stamp(message.header, world.sim_time_ns)
    graph.look()
    for vertex in graph.movers:
        _put(message, vertex.number, "Pose", _pose(vertex.pose))
    return message


def _put(message: SerializedStateMap, entity: int, name: str, data: bytes) -> None:
    kind = component_type(name)
    holder = message.entities[entity]
    holder.id = entity
    # The key of the map is a signed number, the type an unsigned one.
    component = holder.components[kind - (1 << 64) if kind >> 63 else kind]
    component.type, component.component = kind, data


def _parts_by_number(scene: Any) -> dict[int, Any]:
    """Return the messages of all entities in a gz.msgs.Scene by entity id."""
    found: dict[int, Any] = {}
    waiting = [*scene.model, *scene.light, *scene.joint]
    while waiting:
        part = waiting.pop()
        found[part.id] = part
        for name in ("model", "link", "joint", "visual", "collision", "sensor", "light"):
            if name in part.DESCRIPTOR.fields_by_name:
                waiting.extend(getattr(part, name))
    return found


def _components(vertex: Vertex, part: Any, world: WorldAccess) -> Components:
    """Yield the components of one entity; `part` is its message in the scene."""
    yield vertex.kind.capitalize(), b"" if vertex.kind != "light" else part.SerializeToString()
    yield "Name", vertex.name.encode()
    if vertex.parent is None:
        yield "Gravity", _text(*world.description.gravity)
        yield "MagneticField", _text(*world.description.magnetic_field)
        return
    yield "ParentEntity", _text(vertex.parent.number)
    yield "Pose", _pose(vertex.pose)
    special = _SPECIAL.get(vertex.kind)
    if special is not None:
        yield from special(vertex, part, world)


def _model(vertex: Vertex, part: Any, world: WorldAccess) -> Components:
    yield "Static", _text(vertex.static)
    top = vertex
    while top.parent is not None and top.parent.kind == "model":
        top = top.parent
    yield "ModelCanonicalLink", _text(world.entities.number("link", top.name, vertex.described.canonical_link))
    if isinstance(vertex.described, Model):
        yield "SelfCollide", _text(part.self_collide)


def _link(vertex: Vertex, part: Any, world: WorldAccess) -> Components:
    if part.canonical:
        yield "CanonicalLink", b""
    yield "Inertial", part.inertial.SerializeToString()


def _visual(vertex: Vertex, part: Any, world: WorldAccess) -> Components:
    yield "Geometry", part.geometry.SerializeToString()
    if part.HasField("material"):
        yield "Material", part.material.SerializeToString()
    yield "CastShadows", _text(part.cast_shadows)
    yield "Transparency", _text(part.transparency)


def _collision(vertex: Vertex, part: Any, world: WorldAccess) -> Components:
    yield "Geometry", part.geometry.SerializeToString()


def _joint(vertex: Vertex, part: Any, world: WorldAccess) -> Components:
    yield "JointType", _text(JOINT_TYPES.index(vertex.described.kind))
    yield "ParentLinkName", part.parent.encode()
    yield "ChildLinkName", part.child.encode()
    for name, field in (("JointAxis", "axis1"), ("JointAxis2", "axis2")):
        if part.HasField(field):
            yield name, getattr(part, field).SerializeToString()


def _sensor(vertex: Vertex, part: Any, world: WorldAccess) -> Components:
    if part.topic:
        yield "SensorTopic", part.topic.encode()


def _light(vertex: Vertex, part: Any, world: WorldAccess) -> Components:
    yield "LightType", vertex.described.kind.encode()


_SPECIAL: dict[str, Callable[[Vertex, Any, WorldAccess], Components]] = {
    "model": _model,
    "link": _link,
    "visual": _visual,
    "collision": _collision,
    "joint": _joint,
    "sensor": _sensor,
    "light": _light,
}


def _text(*values: float) -> bytes:
    return " ".join(f"{float(value) + 0.0:.9g}" for value in values).encode()


def _pose(pose: Pose) -> bytes:
    return _text(*pose.position, *pose.rpy())
