"""What libsdformat reads with or without a word, and what therefore runs here, with a warning."""

from __future__ import annotations

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.plugins.system import GAZEBO_SYSTEMS, find_system, other_gazebo_systems, systems
from gz_course.sim.gz.sim.sdf.element import parse
from gz_course.sim.gz.sim.sdf.reader import read_world

LINK = "<link name='l'><inertial><mass>1</mass></inertial></link>"


def read(text: str) -> tuple[object, list[str]]:
    diagnostics = Diagnostics(quiet=True)
    world = read_world(f"<sdf version='1.9'><world name='w'>{text}</world></sdf>", "<string>", diagnostics)
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
