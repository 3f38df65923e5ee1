"""The serialized state: entities and components as Gazebo's own tools read them."""

from __future__ import annotations

from typing import Any

import pytest

from gz_course.sim.gz.msgs.geometry_pb2 import Geometry
from gz_course.sim.gz.msgs.inertial_pb2 import Inertial
from gz_course.sim.gz.msgs.light_pb2 import Light
from gz_course.sim.gz.sim.scene.graph import SceneGraph
from gz_course.sim.gz.sim.scene.state import component_type, full_state, pose_state
from gz_course.sim.gz.sim.world import World


def components(state: Any, entity: int) -> dict[int, bytes]:
    return {each.type: each.component for each in state.entities[entity].components.values()}


def component(state: Any, entity: int, name: str) -> bytes:
    return components(state, entity)[component_type(name)]


def test_types_are_fnv_1a_hashes_of_the_registered_names() -> None:
    # Reference values of the hash by the authors of FNV: of the empty text and of "a".
    from gz_course.sim.gz.sim.scene import state

    assert state.fnv_1a("") == 0xCBF29CE484222325
    assert state.fnv_1a("a") == 0xAF63DC4C8601EC8C
    assert state.fnv_1a("foobar") == 0x85944171F73967E8
    assert component_type("Name") == state.fnv_1a("gz_sim_components.Name")


def test_every_entity_has_a_name_and_all_but_the_world_a_parent(world: World) -> None:
    state = full_state(world, SceneGraph(world))
    assert set(state.entities) == {entity.number for entity in world.entities}
    for entity in world.entities:
        assert state.entities[entity.number].id == entity.number
        assert component(state, entity.number, "Name").decode() == entity.name
        kind = "Sensor" if entity.kind == "sensor" else entity.kind.capitalize()
        assert component_type(kind) in components(state, entity.number)
        if entity.kind != "world":
            assert int(component(state, entity.number, "ParentEntity")) in state.entities


def test_components_can_be_read_as_gazebo_does(world: World) -> None:
    state, number = full_state(world, SceneGraph(world)), world.entities.number
    assert state.has_one_time_component_changes
    assert component(state, number("model", "robot"), "Pose") == b"1 2 0.5 0 0 1.57079633"
    assert component(state, number("model", "floor"), "Static") == b"1"
    assert component(state, number("model", "robot"), "ModelCanonicalLink") == b"%d" % number("link", "robot", "base")
    assert component(state, number("link", "robot", "base"), "CanonicalLink") == b""
    assert Inertial.FromString(component(state, number("link", "robot", "base"), "Inertial")).mass == 3
    box = Geometry.FromString(component(state, number("visual", "robot", "base", "body"), "Geometry"))
    assert box.box.size.z == 3
    axle = number("joint", "robot", "axle")
    assert component(state, axle, "JointType") == b"6"
    assert component(state, axle, "ChildLinkName") == b"wheel"
    assert Light.FromString(component(state, number("light", "sun"), "Light")).type == Light.DIRECTIONAL
    assert component(state, number("world", "w"), "Gravity") == b"0 0 0"


def test_keys_are_the_types_as_signed_numbers(world: World) -> None:
    state = full_state(world, SceneGraph(world))
    for entity in state.entities.values():
        for key, each in entity.components.items():
            assert key % (1 << 64) == each.type


def test_of_what_moves_only_the_pose(world: World) -> None:
    graph = SceneGraph(world)
    world.data.qvel[0] = 1.0
    world.step(100)
    state = pose_state(world, graph)
    assert not state.has_one_time_component_changes
    assert set(state.entities) == {vertex.number for vertex in graph.movers}
    x, *_ = component(state, world.entities.number("model", "robot"), "Pose").split()
    assert float(x) == pytest.approx(world.truth.pose("robot").position[0])
    assert (state.header.stamp.sec, state.header.stamp.nsec) == (0, 100_000_000)
