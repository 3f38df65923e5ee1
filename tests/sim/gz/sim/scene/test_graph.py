"""The scene graph: parents, order and poses of the vertices."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.pose import Pose, quaternion_from_rpy
from gz_course.sim.gz.sim.scene import graph as graph_module
from gz_course.sim.gz.sim.scene.graph import SceneGraph, Vertex
from gz_course.sim.gz.sim.world import World


def names(vertex: Vertex) -> dict[str, object]:
    return {f"{child.kind} {child.name}": names(child) for child in vertex.children}


def found(graph: SceneGraph, scoped_name: str) -> Vertex:
    return next(vertex for vertex in graph if vertex.scoped_name() == scoped_name)


def test_everything_hangs_below_its_parent(world: World) -> None:
    assert names(SceneGraph(world).root) == {
        "model floor": {"link slab": {"visual look": {}, "collision touch": {}}},
        "model robot": {
            "model arm": {
                "link hand": {"visual palm": {}},
                "link finger": {},
                "joint knuckle": {},
            },
            "link base": {"visual body": {}, "visual head": {}, "sensor eye": {}, "light lamp": {}},
            "link wheel": {"visual tyre": {}},
            "joint axle": {},
            "joint shoulder": {},
        },
        "light sun": {},
    }


def test_numbers_are_those_of_the_entities_and_no_two_are_alike(world: World) -> None:
    graph = SceneGraph(world)
    numbers = [graph.root.number, *(vertex.number for vertex in graph)]
    assert sorted(numbers) == sorted(entity.number for entity in world.entities)
    assert found(graph, "robot::arm::hand::palm").number == world.entities.number(
        "visual", "robot", "arm::hand", "palm"
    )
    assert found(graph, "robot::base::lamp").number == world.entities.number("light", "robot", "base", "lamp") > 0


def test_poses_are_in_the_parents_frame(world: World) -> None:
    graph = SceneGraph(world)
    graph.look()
    expected = {
        "floor": Pose((0, 0, -1)),
        "robot": Pose.from_rpy((1, 2, 0.5), (0, 0, math.pi / 2)),
        "robot::arm": Pose((0, 0, 1)),
        "robot::arm::hand": Pose((0.5, 0, 0)),
        "robot::wheel": Pose.from_rpy((0, 1, 0), (math.pi / 2, 0, 0)),
        "robot::base::eye": Pose((0.3, 0, 0)),
        "sun": Pose((0, 0, 10)),
    }
    for name, pose in expected.items():
        assert found(graph, name).pose.is_close(pose, 1e-9), name


def test_poses_follow_what_moves_and_chain_to_the_truth(world: World) -> None:
    graph = SceneGraph(world)
    assert {vertex.scoped_name() for vertex in graph.movers} == {
        *("robot", "robot::base", "robot::wheel", "robot::arm", "robot::arm::hand", "robot::arm::finger")
    }
    world.data.qvel[:] = np.linspace(0.3, 1.0, world.model.nv)
    world.step(200)
    graph.look()
    for link in ("base", "wheel", "arm::hand", "arm::finger"):
        vertex: Vertex | None = found(graph, f"robot::{link}")
        chained = Pose()
        while vertex is not None:
            chained = vertex.pose * chained
            vertex = vertex.parent
        assert chained.is_close(world.truth.link_pose("robot", link), 1e-9)
    assert found(graph, "robot").pose.is_close(world.truth.pose("robot"), 1e-9)
    assert found(graph, "robot::base").pose.is_close(Pose(), 1e-9)
    assert found(graph, "robot::arm::hand").pose.is_close(Pose((0.5, 0, 0)), 1e-6)
    assert not found(graph, "robot::wheel").pose.is_close(Pose.from_rpy((0, 1, 0), (math.pi / 2, 0, 0)), 1e-3)


def test_a_static_model_inside_a_moving_one_stays_where_it_is(load_text: Callable[..., World]) -> None:
    world = load_text(
        "<model name='m'><pose>3 0 5 0 0 0</pose><link name='a'/>"
        "<model name='n'><pose>1 0 0 0 0 0</pose><static>true</static><link name='b'/></model></model>"
    )
    world.step(300)
    graph = SceneGraph(world)
    graph.look()
    inside = found(graph, "m::n")
    assert found(graph, "m").pose.position[2] < 4.9
    assert (found(graph, "m").pose * inside.pose).is_close(Pose((4, 0, 5)), 1e-9)
    assert inside.children[0].static


def test_a_graph_of_one_model(world: World) -> None:
    graph = SceneGraph(world, [world.description.models[1]])
    assert [vertex.name for vertex in graph.root.children] == ["robot"]
    assert len(graph.movers) == 6


def test_a_model_held_by_the_world_stands_where_it_is_set_down(load_world_fixed: World) -> None:
    graph = SceneGraph(load_world_fixed)
    graph.look()
    assert found(graph, "post").pose.is_close(Pose((3, 0, 0)), 1e-9)
    assert found(graph, "post::pole").pose.is_close(Pose((0, 0, 1)), 1e-9)


@pytest.fixture
def load_world_fixed(load_text: Callable[..., World]) -> World:
    return load_text(
        "<model name='post'><pose>3 0 0 0 0 0</pose><link name='pole'><pose>0 0 1 0 0 0</pose></link>"
        "<joint name='fix' type='fixed'><parent>world</parent><child>pole</child></joint></model>"
    )


def test_the_dot_text_has_every_vertex_and_edge(world: World) -> None:
    graph = SceneGraph(world)
    lines = graph.dot().splitlines()
    assert (lines[0], lines[-1]) == ("digraph {", "}")
    hand, palm = found(graph, "robot::arm::hand"), found(graph, "robot::arm::hand::palm")
    assert f'  {palm.number} [label="palm ({palm.number})"];' in lines
    assert f"  {hand.number} -> {palm.number} [label=1];" in lines
    count = len(list(graph))
    assert len([line for line in lines if "->" in line]) == count
    assert len([line for line in lines if 'label="' in line]) == count + 1


FLOATS = st.floats(-10, 10)
POSES = st.builds(
    lambda position, rpy: Pose(position, quaternion_from_rpy(*rpy)),
    st.tuples(FLOATS, FLOATS, FLOATS),
    st.tuples(FLOATS, FLOATS, FLOATS),
)


@given(st.lists(st.tuples(POSES, POSES), min_size=1, max_size=4))
def test_chains_of_arrays_are_those_of_single_poses(pairs: list[tuple[Pose, Pose]]) -> None:
    arrays = [
        np.array([getattr(pair[which], part) for pair in pairs])
        for which in (0, 1)
        for part in ("position", "quaternion")
    ]
    for (first, then), position, quaternion in zip(pairs, *graph_module._chain(*arrays), strict=True):
        assert Pose(position, quaternion).is_close(first * then, 1e-9)
