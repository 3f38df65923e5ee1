"""The frame rules of SDF: relative_to, attached_to, scoped names, placement frames, old notations, cycles."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.description import Model
from gz_course.sim.gz.sim.sdf.reader import read_world


def model(inside: str, attributes: str = "", version: str = "1.10") -> Model:
    text = f"<sdf version='{version}'><world name='w'><model name='m' {attributes}>{inside}</model></world></sdf>"
    return read_world(text, "f.sdf", Diagnostics()).models[0]


def test_default_frames() -> None:
    made = model(
        "<pose>1 0 0 0 0 1.5707963267948966</pose>"
        "<link name='a'><pose>0 1 0 0 0 0</pose></link>"
        "<link name='b'><pose>0 0 2 0 0 0</pose></link>"
        "<joint name='j' type='revolute'><pose>0.5 0 0 0 0 0</pose><parent>a</parent><child>b</child>"
        "<axis><xyz>1 0 0</xyz></axis></joint>"
    )
    assert made.pose.is_close(Pose.from_rpy((1, 0, 0), (0, 0, math.pi / 2)))
    assert made.links[0].pose.is_close(Pose((0, 1, 0)))
    assert made.joints[0].pose.is_close(Pose((0.5, 0, 0)))


def test_relative_to_links_joints_and_frames_in_any_order() -> None:
    made = model(
        "<link name='c'><pose relative_to='f'>0 0 1 0 0 0</pose></link>"
        "<frame name='f' attached_to='a'><pose relative_to='j'>1 0 0 0 0 0</pose></frame>"
        "<joint name='j' type='fixed'><pose>0 0 0 0 0 1.5707963267948966</pose><parent>a</parent>"
        "<child>b</child></joint>"
        "<link name='a'><pose>5 0 0 0 0 0</pose></link>"
        "<link name='b'><pose relative_to='a'>0 2 0 0 0 0</pose></link>"
    )
    poses = {link.name: link.pose for link in made.links}
    assert poses["b"].is_close(Pose((5, 2, 0)))
    assert poses["c"].is_close(Pose.from_rpy((5, 3, 1), (0, 0, math.pi / 2)))


def test_a_frame_without_pose_stands_where_it_is_attached() -> None:
    made = model(
        "<link name='a'><pose>1 2 3 0 0 0</pose><visual name='v'><pose relative_to='f'>0 0 1 0 0 0</pose>"
        "<geometry><sphere><radius>1</radius></sphere></geometry></visual></link>"
        "<link name='b'><pose>4 2 3 0 0 0</pose></link><frame name='f' attached_to='b'/>"
    )
    assert made.links[0].visuals[0].pose.is_close(Pose((3, 0, 1)))


def test_joint_axis_expressed_in_another_frame_and_in_old_files() -> None:
    body = (
        "<link name='a'/><link name='b'><pose>0 0 0 0 0 1.5707963267948966</pose></link>"
        "<joint name='j' type='revolute'><parent>a</parent><child>b</child><axis>{}</axis></joint>"
    )
    direct = model(body.format("<xyz>1 0 0</xyz>")).joints[0].axis
    expressed = model(body.format("<xyz expressed_in='__model__'>1 0 0</xyz>")).joints[0].axis
    spelled = model(body.format("<xyz>1 0 0</xyz><use_parent_model_frame>1</use_parent_model_frame>"), version="1.6")
    oldest = model(body.format("<xyz>1 0 0</xyz>"), version="1.4").joints[0].axis
    assert direct and expressed and oldest and spelled.joints[0].axis
    assert np.allclose(direct.direction, (1, 0, 0), atol=1e-12)
    for axis in (expressed, oldest, spelled.joints[0].axis):
        assert np.allclose(axis.direction, (0, -1, 0), atol=1e-12)


def test_nested_models_are_flattened_with_scoped_names() -> None:
    made = model(
        "<link name='base'/>"
        "<model name='arm'><pose>0 0 1 0 0 1.5707963267948966</pose>"
        "  <link name='hand'><pose>1 0 0 0 0 0</pose></link>"
        "  <model name='tip'><pose relative_to='hand'>1 0 0 0 0 0</pose><link name='l'/></model></model>"
        "<joint name='weld' type='fixed'><parent>base</parent><child>arm::hand</child></joint>"
        "<frame name='at_tip' attached_to='arm::tip::l'/>"
        "<link name='top'><pose relative_to='at_tip'>0 0 1 0 0 0</pose></link>"
    )
    poses = {link.name: link.pose for link in made.links}
    assert poses["arm::hand"].is_close(Pose.from_rpy((0, 1, 1), (0, 0, math.pi / 2)))
    assert poses["arm::tip::l"].is_close(Pose.from_rpy((0, 2, 1), (0, 0, math.pi / 2)))
    assert poses["top"].position == pytest.approx((0, 2, 2))
    assert (made.joints[0].parent, made.joints[0].child) == ("base", "arm::hand")


def test_placement_frame_puts_that_frame_at_the_pose() -> None:
    made = model("<pose>3 0 0 0 0 0</pose><link name='a'><pose>1 1 0 0 0 0</pose></link>", "placement_frame='a'")
    assert (made.pose * made.links[0].pose).is_close(Pose((3, 0, 0)))


def test_models_relative_to_other_models_and_world_frames() -> None:
    text = """<sdf version='1.10'><world name='w'>
      <model name='second'><pose relative_to='first'>1 0 0 0 0 0</pose><link name='l'/></model>
      <model name='first'><pose relative_to='corner'>0 2 0 0 0 0</pose><link name='l'/></model>
      <frame name='corner'><pose>0 0 3 0 0 0</pose></frame></world></sdf>"""
    world = read_world(text, "f", Diagnostics())
    assert [tuple(each.pose.position) for each in world.models] == [(1, 2, 3), (0, 2, 3)]


def test_joint_to_a_frame_means_the_link_behind_it() -> None:
    made = model(
        "<link name='a'/><link name='b'/><frame name='g' attached_to='f'/><frame name='f' attached_to='b'/>"
        "<joint name='j' type='ball'><parent>__model__</parent><child>g</child></joint>"
    )
    assert (made.joints[0].parent, made.joints[0].child) == ("a", "b")


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        ("<link name='a'><pose relative_to='b'>0 0 0 0 0 0</pose></link>\n<link name='b'><pose "
"relative_to='a'/></link>", "circle"),
        ("<link name='base'><pose relative_to='bse'/></link><link name='x'/>", "did you mean 'base'"),
        ("<link name='a'/><link name='a'/>", "is already"),
        ("<link name='a'/><frame name='f' attached_to='g'/><frame name='g' attached_to='f'/>"
         "<joint name='j' type='fixed'><parent>a</parent><child>f</child></joint>", "itself|circle"),
        ("<link name='__model__'/>", "reserved"),
        ("<link name='a::b'/>", "must not contain '::'"),
        ("<link/>", "needs a name"),
    ],
)  # fmt: skip
def test_frames_that_make_no_sense_are_refused_at_their_line(inside: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence) as caught:
        model(inside)
    assert str(caught.value).startswith("f.sdf:")


numbers = st.floats(-3, 3)
pose_texts = st.tuples(*[numbers] * 6)


@given(st.lists(pose_texts, min_size=1, max_size=6), st.randoms(use_true_random=False))
def test_a_chain_of_links_is_the_product_of_its_poses_in_any_order(
    chain: list[tuple[float, ...]], random: Callable
) -> None:
    links = []
    expected = Pose()
    for index, numbers_of_pose in enumerate(chain):
        base = f"relative_to='l{index - 1}'" if index else ""
        values = " ".join(map(repr, numbers_of_pose))
        links.append(f"<link name='l{index}'><pose {base}>{values}</pose></link>")
        expected = expected * Pose.from_rpy(numbers_of_pose[:3], numbers_of_pose[3:])
    random.shuffle(links)
    made = model("".join(links))
    last = made.link(f"l{len(chain) - 1}")
    assert last is not None and last.pose.is_close(expected, 1e-9)


@pytest.mark.parametrize(
    ("frames", "sentence"),
    [
        ("<frame name='f' attached_to='tabel'/>", "model 'm' has no frame 'tabel'; did you mean 'table'?"),
        ("<frame name='f'><pose relative_to='tabel'/></frame>", "model 'm' has no frame 'tabel'"),
        ("<frame name='f' attached_to='table'><pose relative_to='no'/></frame>", "model 'm' has no frame 'no'"),
        ("<frame name='f' attached_to='no'><pose relative_to='table'/></frame>", "model 'm' has no frame 'no'"),
        ("<frame name='f' attached_to='f'/>", "in a circle: f -> f"),
        ("<frame name='f' attached_to='g'/><frame name='g' attached_to='f'/>", "in a circle: f -> g -> f"),
        (
            "<frame name='f' attached_to='g'><pose relative_to='table'/></frame>"
            "<frame name='g' attached_to='f'><pose relative_to='table'/></frame>",
            "attached to each other in a circle: f -> g -> f",
        ),
    ],
)
def test_a_frame_that_nothing_uses_must_have_a_base(frames: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=re.escape(sentence)):
        model(f"<link name='table'/>{frames}")


def test_a_frame_of_the_world_must_have_a_base() -> None:
    text = """<sdf version='1.9'><world name='w'>
      <frame name='shelf' attached_to='tabel'><pose>0 0 1 0 0 0</pose></frame>
      <model name='table'><static>1</static><link name='l'/></model></world></sdf>"""
    with pytest.raises(SdfError, match=r"f\.sdf:2: the world has no frame 'tabel'; did you mean 'table'"):
        read_world(text, "f.sdf", Diagnostics())
    assert read_world(text.replace("tabel", "table"), "f.sdf", Diagnostics()).models[0].name == "table"


def test_a_frame_on_an_include_that_is_not_found_is_no_second_fault() -> None:
    text = """<sdf version='1.9'><world name='w'><frame name='f' attached_to='gone'/>
      <include><uri>model://no_such_model</uri><name>gone</name></include>
      <model name='table'><static>1</static><link name='l'/></model></world></sdf>"""
    assert [each.name for each in read_world(text, "f.sdf", Diagnostics()).models] == ["table"]
