"""A running world written as SDF loads again with the same poses."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.element import Element, parse
from gz_course.sim.gz.sim.sdf.writer import pose_element, to_xml
from gz_course.sim.gz.sim.sdf_generator import generate_world
from gz_course.sim.gz.sim.world import World

Load = Callable[..., World]


@pytest.mark.parametrize("expand", [False, True])
def test_the_present_world_comes_back(expand: bool) -> None:
    world = World.load("lidar_room.sdf")
    world.editor.spawn(
        "<sdf version='1.10'><model name='box'><pose>3 1 2 0.1 0.2 0.3</pose><link name='l'/></model></sdf>"
    )
    world.editor.spawn("<sdf version='1.10'><light name='lamp' type='point'><pose>0 1 2 0 0 0</pose></light></sdf>")
    drive = next(each for each in world.systems if each.name == "DiffDrive")
    drive.command(0.3, 0.4)  # type: ignore[attr-defined]
    world.step(800)
    world.editor.set_pose("crate", Pose((1.0, 2.0, 0.25)))
    world.editor.remove("pillar" if "pillar" in world.truth.model_names(static=True) else "ground_plane")
    world.editor.set_physics(step_size=0.002)
    text = generate_world(world, expand_includes=expand)
    assert ("<include>" in text) is not expand
    again = World.from_string(text)
    assert again.truth.model_names(static=True) == world.truth.model_names(static=True)
    for name in world.truth.model_names(static=True):
        assert again.truth.pose(name).is_close(world.truth.pose(name), 1e-12), name
    assert [(light.name, light.kind) for light in again.description.lights] == [
        (light.name, light.kind) for light in world.description.lights
    ]
    assert again.step_size_ns == 2_000_000
    assert [each.name for each in again.systems] == [each.name for each in world.systems]
    assert generate_world(again, expand_includes=expand) == generate_world(
        World.from_string(generate_world(again, expand_includes=expand)), expand_includes=expand
    )


def test_old_versions_have_their_poses_in_angles(load_text: Load) -> None:
    world = load_text("<model name='m'><pose>1 2 3 0.1 0.2 0.3</pose><link name='l'/></model>", version="1.6")
    text = generate_world(world)
    assert "quat_xyzw" not in text and 'version="1.6"' in text
    assert World.from_string(text).truth.pose("m").is_close(world.truth.pose("m"), 1e-12)


def test_a_model_of_older_rules_is_warned_about(load_text: Load, caplog: pytest.LogCaptureFixture) -> None:
    world = load_text("")
    for version in ("1.9", "1.4"):
        world.editor.spawn(
            f"<sdf version='{version}'><model name='m'><link name='l'/></model></sdf>", allow_renaming=True
        )
    generate_world(world)
    assert [record.getMessage().split(" but")[0] for record in caplog.records] == [
        "model 'm_0' follows the rules of SDF 1.4"
    ]


def test_joints_between_models_go_with_their_models(load_text: Load) -> None:
    inside = "".join(
        f"<model name='{name}'><pose>{x} 0 0 0 0 0</pose><link name='l'/></model>"
        for x, name in enumerate(("a", "aa", "b"))
    )
    for name, parent in (("one", "a"), ("two", "aa")):
        inside += f"<joint name='{name}' type='fixed'><parent>{parent}::l</parent><child>b::l</child></joint>"
    world = load_text(inside)
    world.editor.remove("a")
    assert [joint.name for joint in world.description.joints] == ["two"]
    again = World.from_string(generate_world(world))
    assert [joint.name for joint in again.description.joints] == ["two"]
    world.reset()
    assert [joint.name for joint in world.description.joints] == ["one", "two"]


def test_models_that_other_frames_placed(load_text: Load) -> None:
    inside = (
        "<frame name='f'><pose>1 0 0 0 0 1</pose></frame>"
        "<model name='m' placement_frame='l'><pose relative_to='f'>0 1 0 0 0 0</pose>"
        "<link name='l'><pose>0 0 2 0.2 0 0</pose></link></model>"
    )
    world = load_text(inside)
    assert World.from_string(generate_world(world)).truth.pose("m").is_close(world.truth.pose("m"), 1e-12)


words = st.text(st.characters(codec="utf-8", exclude_categories=("Cs", "Cc")), max_size=12)
names = st.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True)
elements = st.recursive(
    st.builds(lambda tag, attributes, text: Element(tag, attributes, text.strip()), names,
              st.dictionaries(names, words, max_size=3), words),
    lambda inner: st.builds(lambda tag, children: Element(tag, {}, "", children), names, st.lists(inner, max_size=3)),
    max_leaves=8,
)  # fmt: skip


def same(one: Element, other: Element) -> bool:
    return (one.tag, one.attributes, one.text) == (other.tag, other.attributes, other.text) and (
        len(one.children) == len(other.children)
        and all(same(*pair) for pair in zip(one.children, other.children, strict=True))
    )


@given(elements)
def test_what_is_written_reads_back(element: Element) -> None:
    assert same(parse(to_xml(element)), element)


numbers = st.floats(-1e6, 1e6)


@given(st.tuples(numbers, numbers, numbers), st.tuples(*[st.floats(-3, 3)] * 3))
def test_poses_read_back_to_the_last_digit(position: tuple[float, ...], rpy: tuple[float, ...]) -> None:
    pose = Pose.from_rpy(position, rpy)
    read = pose_element(pose, (1, 10)).pose()
    assert (read.position == pose.position).all()
    assert read.is_close(pose, 1e-15)
    assert pose_element(pose, (1, 6)).pose().is_close(pose, 1e-7)
