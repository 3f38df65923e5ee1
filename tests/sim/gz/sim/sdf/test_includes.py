"""Includes: overrides, merging, placement, lights, worlds, files that include each other, missing files."""

from __future__ import annotations

from pathlib import Path

import pytest

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.description import WorldDescription
from gz_course.sim.gz.sim.sdf.reader import read_world, read_world_file

ARM = """<sdf version='1.9'><model name='arm'><pose>0 0 5 0 0 0</pose>
<link name='upper'><pose>1 0 0 0 0 0</pose></link>
<link name='lower'><pose relative_to='upper'>1 0 0 0 0 0</pose></link>
<frame name='grip' attached_to='lower'><pose>0 0 1 0 0 0</pose></frame>
<frame name='middle'><pose>0 2 0 0 0 0</pose></frame>
<joint name='elbow' type='revolute'><parent>upper</parent><child>lower</child>
  <axis><xyz expressed_in='__model__'>0 1 0</xyz></axis></joint>
<joint name='whole' type='fixed'><parent>world</parent><child>__model__</child></joint>
<plugin filename='a' name='own'/></model></sdf>"""


@pytest.fixture
def shelf(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path))
    put(tmp_path, "arm", ARM)
    return tmp_path


def put(folder: Path, name: str, text: str) -> None:
    (folder / name).mkdir()
    (folder / name / "model.sdf").write_text(text)


def read(inside: str) -> tuple[WorldDescription, list[str]]:
    diagnostics = Diagnostics()
    world = read_world(f"<sdf version='1.11'>\n<world name='w'>\n{inside}\n</world></sdf>", "f.sdf", diagnostics)
    return world, diagnostics.warnings


def test_a_merged_include_puts_its_parts_beside_it(shelf: Path) -> None:
    world, warnings = read(
        "<model name='m'><link name='base'/><include merge='true'><uri>model://arm</uri>"
        "<pose relative_to='base'>0 0 1 0 0 1.5707963267948966</pose><plugin filename='b' name='added'/></include>"
        "<joint name='j' type='fixed'><parent>base</parent><child>upper</child></joint>"
        "<link name='tip'><pose relative_to='grip'/></link>"
        "<link name='side'><pose relative_to='middle'/></link></model>"
    )
    model = world.models[0]
    poses = {link.name: link.pose for link in model.links}
    assert ["'tip'" in each for each in warnings] == [True] and model.nested == []
    assert list(poses) == ["base", "upper", "lower", "tip", "side"]
    assert poses["upper"].position == pytest.approx((0, 1, 1))
    assert poses["lower"].position == pytest.approx((0, 2, 1))
    assert poses["tip"].position == pytest.approx((0, 2, 2))
    assert poses["side"].position == pytest.approx((-2, 0, 1))
    assert {joint.name: (joint.parent, joint.child) for joint in model.joints} == {
        "elbow": ("upper", "lower"),
        "whole": ("world", "upper"),
        "j": ("base", "upper"),
    }
    # The y axis of the file in the frame of its link, which is rotated with the model.
    assert next(j for j in model.joints if j.name == "elbow").axis.direction == pytest.approx((0, 1, 0))  # type: ignore[union-attr]
    assert [plugin.name for plugin in model.plugins] == ["own", "added"]
    assert model.canonical_link == "base"


def test_a_merged_include_without_pose_stands_where_its_file_says(shelf: Path) -> None:
    world, _ = read("<model name='m'><include merge='true'><uri>model://arm</uri></include></model>")
    assert world.models[0].links[0].pose.position == pytest.approx((1, 0, 5))


def test_merged_includes_nest(shelf: Path) -> None:
    put(
        shelf,
        "twice",
        "<sdf version='1.9'><model name='twice'><link name='l'/><include merge='true'><uri>model://arm</uri>"
        "<pose>0 0 1 0 0 0</pose></include></model></sdf>",
    )
    world, warnings = read(
        "<model name='m'><include merge='true'><uri>model://twice</uri><pose>9 0 0 0 0 0</pose></include></model>"
    )
    assert all("no <joint> connects" in each for each in warnings)
    assert [(each.name, tuple(each.pose.position)) for each in world.models[0].links] == [
        ("l", (9, 0, 0)),
        ("upper", (10, 0, 1)),
        ("lower", (11, 0, 1)),
    ]


def test_models_and_whole_worlds_merge_into_a_world(shelf: Path) -> None:
    put(shelf, "pair", "<sdf version='1.9'><model name='pair'><model name='a'><link name='l'/></model></model></sdf>")
    (shelf / "other.sdf").write_text(
        "<sdf version='1.9'><world name='o'><gravity>0 0 0</gravity><model name='b'><pose>1 0 0 0 0 0</pose>"
        "<link name='l'/></model><light name='lamp' type='point'/></world></sdf>"
    )
    world, warnings = read(
        "<include merge='true'><uri>model://pair</uri><pose>0 0 3 0 0 0</pose></include>"
        f"<include merge='true'><uri>{shelf / 'other.sdf'}</uri></include>"
    )
    assert warnings == []
    assert {model.name: tuple(model.pose.position) for model in world.models} == {"a": (0, 0, 3), "b": (1, 0, 0)}
    assert [light.name for light in world.lights] == ["lamp"] and world.gravity[2] == -9.8
    with pytest.raises(SdfError, match="cannot be merged into a <world>"):
        read("<include merge='true'><uri>model://arm</uri></include>")


def test_placement_frame_of_an_include(shelf: Path) -> None:
    world, _ = read(
        "<include><uri>model://arm</uri><pose>1 2 3 0 0 0</pose><placement_frame>grip</placement_frame></include>"
    )
    model = world.models[0]
    grip = model.pose * model.links[1].pose * Pose((0, 0, 1))
    assert grip.position == pytest.approx((1, 2, 3))
    with pytest.raises(SdfError, match=r"^f\.sdf:3: <placement_frame> .* needs a <pose>"):
        read("<include><uri>model://arm</uri><placement_frame>grip</placement_frame></include>")


def test_a_light_is_included_with_another_name_and_pose(shelf: Path) -> None:
    put(shelf, "lamp", "<sdf version='1.9'><light name='lamp' type='spot'><direction>0 0 -2</direction></light></sdf>")
    world, warnings = read("<include><uri>model://lamp</uri><name>left</name><pose>0 1 2 0 0 0</pose></include>")
    light = world.lights[0]
    assert warnings == [] and (light.name, light.kind, light.direction) == ("left", "spot", (0, 0, -1))
    assert light.pose.position == pytest.approx((0, 1, 2))


def test_a_file_may_be_included_often_with_different_overrides(shelf: Path) -> None:
    world, _ = read(
        "".join(
            f"<include><uri>model://arm</uri><name>a{n}</name><pose>{n} 0 0 0 0 0</pose></include>" for n in range(3)
        )
        + "<include><uri>model://arm</uri></include>"
    )
    assert [(model.name, tuple(model.pose.position)) for model in world.models] == [
        ("a0", (0, 0, 0)),
        ("a1", (1, 0, 0)),
        ("a2", (2, 0, 0)),
        ("arm", (0, 0, 5)),
    ]


def test_files_that_include_each_other_are_refused_with_the_circle(shelf: Path) -> None:
    for name, other in (("ping", "pong"), ("pong", "ping")):
        put(
            shelf,
            name,
            f"<sdf version='1.9'><model name='{name}'><include><uri>model://{other}</uri></include></model></sdf>",
        )
    with pytest.raises(
        SdfError, match=r"included inside itself: ping/model\.sdf -> pong/model\.sdf -> ping/model\.sdf"
    ) as caught:
        read("<include><uri>model://ping</uri></include>")
    assert str(caught.value).startswith(str(shelf / "pong" / "model.sdf") + ":1: ")
    (shelf / "loop.sdf").write_text(
        "<sdf version='1.9'><world name='w'><include merge='true'><uri>loop.sdf</uri></include></world></sdf>"
    )
    with pytest.raises(SdfError, match="included inside itself"):
        read_world_file(shelf / "loop.sdf", Diagnostics())


def test_includes_that_double_at_each_level_are_bounded(shelf: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gz_course.sim.gz.sim.sdf.includes.MOST_INCLUDES", 500)
    for level in range(30):
        below = (
            f"<include><uri>model://d{level + 1}</uri><name>{{}}</name></include>" if level < 29 else "<link name='l'/>"
        )
        both = below.format("a") + below.format("b") if level < 29 else below
        put(shelf, f"d{level}", f"<sdf version='1.9'><model name='d'>{both}</model></sdf>")
    with pytest.raises(SdfError, match="more than 500 includes"):
        read("<include><uri>model://d0</uri></include>")


def test_a_joint_to_a_model_that_is_missing_is_skipped_with_it() -> None:
    world, warnings = read(
        "<model name='m'><link name='l'/><include><uri>https://fuel.gazebosim.org/1.0/x/models/Gripper</uri></include>"
        "<joint name='j' type='fixed'><parent>l</parent><child>Gripper::palm</child></joint></model>"
    )
    assert world.models[0].joints == []
    assert len(warnings) == 2 and "joint 'j' is skipped with the include 'Gripper'" in warnings[1]


def test_parameters_that_change_an_include_are_named(shelf: Path) -> None:
    _, warnings = read("<include><uri>model://arm</uri><experimental:params><x/></experimental:params></include>")
    assert len(warnings) == 1 and "<experimental:params> in an <include> is not carried out" in warnings[0]


def test_strict_loading_lists_every_warning_and_refuses() -> None:
    diagnostics = Diagnostics(strict=True)
    text = (
        "<sdf version='1.9'>\n<world name='w'>\n<modle/>\n<include><uri>model://nothing</uri></include></world></sdf>"
    )
    read_world(text, "f.sdf", diagnostics)
    with pytest.raises(SdfError) as caught:
        diagnostics.refuse()
    lines = str(caught.value).splitlines()
    assert "2 warnings" in lines[0]
    assert lines[1].strip().startswith("f.sdf:3: ") and lines[2].strip().startswith("f.sdf:4: ")
    Diagnostics(strict=True).refuse()
    relaxed = Diagnostics()
    read_world(text, "f.sdf", relaxed)
    relaxed.refuse()
