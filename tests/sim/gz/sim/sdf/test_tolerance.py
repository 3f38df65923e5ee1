"""What libsdformat reads with or without a word, and what therefore runs here, with a warning."""

from __future__ import annotations

import pytest

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.plugins.system import GAZEBO_SYSTEMS, find_system, other_gazebo_systems, systems
from gz_course.sim.gz.sim.sdf.element import parse
from gz_course.sim.gz.sim.sdf.reader import read_model, read_world

LINK = "<link name='l'><inertial><mass>1</mass></inertial></link>"


def read(text: str, version: str = "1.9") -> tuple[object, list[str]]:
    diagnostics = Diagnostics(quiet=True)
    world = read_world(f"<sdf version='{version}'><world name='w'>{text}</world></sdf>", "<string>", diagnostics)
    return world, diagnostics.warnings


def test_a_model_of_nothing_but_a_missing_include_is_left_out() -> None:
    missing = "<include><uri>model://not_to_be_had</uri></include>"
    world, warnings = read(
        f"<model name='course'>{missing}</model><model name='robot'>{LINK}{missing}</model>"
        "<joint name='j' type='fixed'><parent>robot::l</parent><child>course</child></joint>"
    )
    assert [model.name for model in world.models] == ["robot"]
    assert world.joints == []
    assert any("model 'course' holds nothing but what was not found" in text for text in warnings)


def test_a_lone_ampersand_stands_for_itself() -> None:
    element = parse("<a name='R & D'>x & y &amp; &#38; &lt; &nbsp; <![CDATA[a & b]]></a>")
    assert element.name == "R & D"
    assert element.text == "x & y & & < &nbsp; a & b"


def test_an_attenuation_below_zero_is_zero() -> None:
    factors = "<constant>-2</constant><quadratic>0.5</quadratic>"
    world, warnings = read(f"<light name='s' type='point'><attenuation>{factors}</attenuation></light>")
    assert (world.lights[0].constant, world.lights[0].quadratic) == (0.0, 0.5)
    assert any("<constant> is -2" in text for text in warnings)


def test_a_joint_between_two_frames_of_one_link_is_left_out() -> None:
    world, warnings = read(
        f"<model name='m'>{LINK}<frame name='a' attached_to='l'/><frame name='b' attached_to='l'/>"
        "<joint name='j' type='fixed'><parent>a</parent><child>b</child></joint></model>"
    )
    assert world.models[0].joints == []
    assert any("'a' and 'b' are both part of link 'l'" in text for text in warnings)


def warning_about(name: str, filename: str) -> str:
    world, _ = read(f"<plugin name='{name}' filename='{filename}'/>")
    diagnostics = Diagnostics(quiet=True)
    assert find_system(world.plugins[0], diagnostics) is None
    return diagnostics.warnings[0]


def test_a_plugin_of_ones_own_is_not_taken_for_a_misspelt_one() -> None:
    assert "did you mean" not in warning_about("Obstacle1Plugin", "libObstacle1Plugin.so")
    assert "did you mean 'TouchPlugin'" in warning_about("gz::sim::systems::TouchPlugn", "gz-sim-touchplugn-system")
    missing = min(other_gazebo_systems())
    assert "exists in Gazebo but not in this simulator" in warning_about(f"gz::sim::systems::{missing}", "x")


def test_no_system_that_runs_here_is_called_missing() -> None:
    assert not other_gazebo_systems() & systems().keys()
    assert systems().keys() <= GAZEBO_SYSTEMS | {"ViewBroadcaster"}, "or the list is not that of Gazebo"


def test_a_joint_whose_ends_are_one_link_of_a_nested_model_is_left_out() -> None:
    world, warnings = read(
        f"<model name='m'><link name='b'/><frame name='f' attached_to='n::g'/><model name='n'><frame name='g'/>{LINK}"
        "</model><joint name='j' type='ball'><parent>f</parent><child>n::g</child></joint></model>"
    )
    assert world.models[0].joints == []
    assert any("'f' and 'n::g' are both part of link 'n::l'" in text for text in warnings)


def test_before_sdf_1_7_a_name_that_is_taken_is_changed() -> None:
    model = (
        f"<model name='m'>{LINK}<link name='b'/><joint name='b' type='ball'><parent>l</parent><child>b</child></joint>"
        "<frame name='l'/></model>"
    )
    world, warnings = read(model, "1.6")
    assert [joint.name for joint in world.models[0].joints] == ["b_joint"]
    assert len(warnings) == 2 and "it is now 'l_frame'" in warnings[1]
    with pytest.raises(SdfError, match="names in one model must differ"):
        read(model, "1.7")


def test_before_sdf_1_8_a_name_may_be_that_of_a_part_of_a_nested_model() -> None:
    model = (
        f"<model name='m'>{LINK}<link name='x::y::main'><pose>1 0 0 0 0 0</pose></link><joint name='x::j' type='fixed'>"
        "<parent>l</parent><child>x::y::main</child></joint><frame name='f' attached_to='x::y::main'/></model>"
    )
    (made,) = read(model, "1.7")[0].models
    assert [link.name for link in made.links] == ["l", "x::y::main"]
    assert (made.joints[0].name, made.joints[0].child) == ("x::j", "x::y::main")
    with pytest.raises(SdfError, match="must not contain '::'"):
        read(model, "1.8")


def test_what_is_too_far_away_is_left_out() -> None:
    far = "<pose>0 0 -2e7 0 0 0</pose>"
    model = f"<model name='far'>{far}{LINK}</model>"
    world, warnings = read(f"<model name='near'>{LINK}</model>{model}<light name='s' type='point'>{far}</light>")
    assert ([each.name for each in world.models], world.lights) == (["near"], [])
    assert len(warnings) == 2 and all("m away from the origin, so it is left out" in text for text in warnings)
    with pytest.raises(SdfError, match=r"is left out; nothing is created$"):
        read_model(f"<sdf version='1.9'>{model}</sdf>", "<string>", Diagnostics(quiet=True))
