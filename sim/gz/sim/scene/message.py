"""Converts a world to gz.msgs.Scene: models with links, visuals, collisions, sensors, joints and lights.

SceneBroadcaster answers `/world/W/scene/info` with `scene_message(world)` and publishes the part for new entities.
Poses are the present ones in the parent's frame; the pose of a joint is in its child link.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/Conversions.cc
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.sim.gz.msgs.joint_pb2 import Joint as JointMessage
from gz_course.sim.gz.msgs.light_pb2 import Light as LightMessage
from gz_course.sim.gz.msgs.scene_pb2 import Scene
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.pose import Pose, rotate
from gz_course.sim.gz.sim.scene.fields import set_colour, set_pose, set_vector
from gz_course.sim.gz.sim.scene.graph import SceneGraph, Vertex
from gz_course.sim.gz.sim.scene.sensors import fill_sensor
from gz_course.sim.gz.sim.scene.shapes import fill_geometry, fill_material, fill_surface, transparency
from gz_course.sim.gz.sim.sdf.description import Axis, Inertial, Joint, Light, Model

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess


def scene_message(world: WorldAccess, graph: SceneGraph | None = None, only: Iterable[int] | None = None) -> Scene:
    """Return the present scene of a world.

    `graph` is an existing scene graph of the world, if there is one; `only` restricts the message to the models and
    lights with these ids.
    """
    graph = graph or SceneGraph(world)
    graph.look()
    return _SceneWriter(world, graph).write(None if only is None else frozenset(only))


class _SceneWriter:
    """Writes the vertices of one graph; `_writers` holds the method for each kind of entity."""

    def __init__(self, world: WorldAccess, graph: SceneGraph) -> None:
        self._world = world
        self._graph = graph
        self._topics = _sensor_topics(world)
        self._writers: dict[str, Callable[[Any, Vertex], None]] = {
            "model": self._model,
            "link": self._link,
            "joint": self._joint,
            "visual": self._visual,
            "collision": self._collision,
            "sensor": self._sensor,
            "light": _light,
        }

    def write(self, only: frozenset[int] | None) -> Scene:
        description = self._world.description
        scene = Scene(name=description.name)
        set_colour(scene.ambient, description.ambient)
        set_colour(scene.background, description.background)
        element = description.element.find("scene")
        scene.shadows = element.flag("shadows", True) if element is not None else True
        scene.grid = element.flag("grid", True) if element is not None else True
        scene.origin_visual = element.flag("origin_visual", True) if element is not None else True
        sky = element.find("sky") if element is not None else None
        if sky is not None:
            scene.sky.time = sky.number("time", 10.0)
            scene.sky.sunrise, scene.sky.sunset = sky.number("sunrise", 6.0), sky.number("sunset", 20.0)
            scene.sky.cubemap_uri = sky.text_of("cubemap_uri")
            scene.sky.wind_speed = sky.number("clouds/speed", 0.6)
            scene.sky.wind_direction = sky.number("clouds/direction", 0.0)
            scene.sky.humidity = sky.number("clouds/humidity", 0.5)
            scene.sky.mean_cloud_size = sky.number("clouds/mean_size", 0.5)
        for vertex in self._graph.root.children:
            if only is None or vertex.number in only:
                self._add(scene, vertex)
        return scene

    def _add(self, parent: Any, vertex: Vertex) -> None:
        """Add a vertex to the list of its kind in the message of its parent, with the fields common to all kinds."""
        message = getattr(parent, vertex.kind).add()
        message.id, message.name = vertex.number, vertex.name
        set_pose(message.pose, vertex.pose)
        try:
            self._writers[vertex.kind](message, vertex)
        except SdfError as error:
            where, _, sentence = str(error).partition(": ")
            self._world.diagnostics.warn_once(str(error), where, f"{sentence}; it is left out of the scene message")
        for child in vertex.children:
            self._add(message, child)

    @staticmethod
    def _model(message: Any, vertex: Vertex) -> None:
        message.is_static = vertex.static
        if isinstance(vertex.described, Model):
            message.self_collide = vertex.described.self_collide

    @staticmethod
    def _link(message: Any, vertex: Vertex) -> None:
        link = vertex.described
        message.self_collide = link.self_collide
        message.gravity = link.gravity
        message.enabled = True
        message.kinematic = link.static
        model = _top(vertex).described
        message.canonical = link.name == model.canonical_link
        _fill_inertial(message.inertial, link.inertial)

    def _visual(self, message: Any, vertex: Vertex) -> None:
        visual = vertex.described
        _parent(message, vertex)
        message.visible = True
        message.is_static = vertex.static
        message.type = message.VISUAL
        message.cast_shadows = visual.element.flag("cast_shadows", True)
        message.transparency = transparency(visual)
        message.laser_retro = visual.element.number("laser_retro", 0.0)
        fill_geometry(message.geometry, visual, self._world.resources)
        material = fill_material(visual, self._world.resources)
        if material is not None:
            message.material.CopyFrom(material)

    def _collision(self, message: Any, vertex: Vertex) -> None:
        collision = vertex.described
        message.laser_retro = collision.element.number("laser_retro", 0.0)
        message.max_contacts = collision.element.number("max_contacts", 10.0)
        fill_geometry(message.geometry, collision, self._world.resources)
        fill_surface(message.surface, collision)

    def _sensor(self, message: Any, vertex: Vertex) -> None:
        _parent(message, vertex)
        fill_sensor(message, vertex.described, self._topics.get(id(vertex.described), ""))

    def _joint(self, message: Any, vertex: Vertex) -> None:
        joint: Joint = vertex.described
        message.type = JointMessage.Type.Value(joint.kind.upper())
        message.parent, message.child = joint.parent, joint.child
        scope = () if vertex.parent is self._graph.root else (_top(vertex).name,)
        number = self._world.entities.number
        for field, name in (("parent_id", joint.parent), ("child_id", joint.child)):
            path = (*scope, name) if scope else tuple(name.split("::", 1))
            setattr(message, field, number("link", *path))
        if joint.axis is not None:
            _fill_axis(message.axis1, joint.axis, joint.pose)
        if joint.axis2 is not None:
            _fill_axis(message.axis2, joint.axis2, joint.pose)
        if joint.kind == "screw":
            message.screw.thread_pitch = joint.thread_pitch
        elif joint.kind == "gearbox":
            message.gearbox.gearbox_ratio = joint.gearbox_ratio
            message.gearbox.gearbox_reference_body = joint.gearbox_reference


def _parent(message: Any, vertex: Vertex) -> None:
    if vertex.parent is None:
        return
    message.parent_id = vertex.parent.number
    name = "parent" if vertex.kind == "sensor" else "parent_name"
    setattr(message, name, vertex.parent.name)


def _top(vertex: Vertex) -> Vertex:
    while vertex.parent is not None and vertex.parent.kind != "world":
        vertex = vertex.parent
    return vertex


def _light(message: Any, vertex: Vertex) -> None:
    light: Light = vertex.described
    if vertex.parent is not None:
        message.parent_id = vertex.parent.number
    fill_light(message, light)


def fill_light(message: Any, light: Light) -> None:
    """Write a light into a gz.msgs.Light, without id, name and pose."""
    message.type = LightMessage.LightType.Value(light.kind.upper())
    set_colour(message.diffuse, light.diffuse)
    set_colour(message.specular, light.specular)
    set_vector(message.direction, light.direction)
    message.attenuation_constant = light.constant
    message.attenuation_linear = light.linear
    message.attenuation_quadratic = light.quadratic
    message.range = light.range
    message.cast_shadows = light.cast_shadows
    message.spot_inner_angle, message.spot_outer_angle = light.inner_angle, light.outer_angle
    message.spot_falloff = light.falloff
    message.intensity = light.intensity
    message.is_light_off = not light.on
    message.visualize_visual = light.visualize


def _fill_inertial(message: Any, inertial: Inertial) -> None:
    message.mass = inertial.mass
    set_pose(message.pose, inertial.pose)
    for name, value in zip(("ixx", "iyy", "izz", "ixy", "ixz", "iyz"), inertial.moments, strict=True):
        setattr(message, name, value)


def _fill_axis(message: Any, axis: Axis, frame: Pose) -> None:
    """Write an axis; its direction is stored in the child link's frame and sent in the joint's frame, as in Gazebo."""
    set_vector(message.xyz, rotate(frame.inverse().quaternion, np.asarray(axis.direction)))
    message.limit_lower, message.limit_upper = axis.lower, axis.upper
    message.limit_effort, message.limit_velocity = axis.effort, axis.velocity
    message.damping, message.friction = axis.damping, axis.friction


def _sensor_topics(world: WorldAccess) -> dict[int, str]:
    """Return the topics of the running sensors, by the `id()` of their descriptions."""
    return {id(sensor.description): sensor.topic for sensor in world.systems.sensors()}
