"""Worlds from SDF: includes, unknown words, invalid values; messages have file, line and the nearest valid name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import Diagnostics, ResourceError, SdfError
from gz_course.sim.gz.sim.sdf.reader import read_world
from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_WORLDS
from gz_course.sim.gz.sim.world import World

ROOM = (BUILT_IN_WORLDS / "lidar_room.sdf").read_text()


def read(inside: str) -> tuple[object, list[str]]:
    diagnostics = Diagnostics()
    text = f"<sdf version='1.10'>\n<world name='w'>\n{inside}\n</world></sdf>"
    return read_world(text, "f.sdf", diagnostics), diagnostics.warnings


@pytest.mark.parametrize("name", sorted(path.name for path in BUILT_IN_WORLDS.glob("*.sdf")))
def test_built_in_worlds_load_without_a_warning(name: str) -> None:
    assert World.load(name).warnings == []


def test_an_unknown_element_is_one_warning_with_the_nearest_word_and_the_rest_runs() -> None:
    world, warnings = read(
        "<model name='m'><static>true</static><link name='l'>\n<colision name='c'/><visual name='v'><geometry><sphere>"
        "<raduis>1</raduis>"
        "</sphere></geometry></visual></link></model>"
    )
    assert len(warnings) == 3
    assert warnings[0].startswith("f.sdf:4: ") and "did you mean 'collision'" in warnings[0]
    assert "<sphere> has no <radius>, so it has the default size" in warnings[2]
    assert "did you mean 'radius'" in warnings[1]
    assert world.models[0].links[0].visuals[0].geometry.kind == "sphere"  # type: ignore[attr-defined]


def test_foreign_prefixes_plugins_and_gui_are_nobodys_business() -> None:
    _, warnings = read("<gz:policies/><gui><anything/></gui><plugin name='gz::sim::systems::Physics'><x/></plugin>")
    assert warnings == []


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        ("<model name='m'/>", "has no link"),
        ("<model><link name='l'/></model>", "needs a name"),
        ("<model name='m'><link name='l'><inertial><mass>0</mass></inertial></link>"
"</model>", "<mass> must be greater"),
        ("<model name='m'><link name='l'><inertial><inertia><ixx>-1</ixx></inertia></inertial>"
"</link></model>", "positive"),
        ("<model name='m'><link name='l'><inertial><inertia><ixx>9</ixx></inertia></inertial>"
"</link></model>", "add up"),
        ("<model name='m'><link name='l'><visual name='v'><geometry><box><size>1 -1 1</size></box>"
"</geometry></visual>"
         "</link></model>", "size of <box>"),
        ("<model name='m'><link name='l'/><joint name='j' type='revolut'><parent>l</parent>"
"<child>l</child></joint></model>",
         "did you mean 'revolute'"),
        ("<model name='m'><link name='base'/><joint name='j' type='fixed'><parent>base</parent>"
"<child>bse</child></joint>"
         "</model>", "did you mean 'base'"),
        ("<model name='m'><link name='a'/><link name='b'/><joint name='j' type='revolute'>"
"<parent>a</parent><child>b</child>"
         "<axis><xyz>0 0 0</xyz></axis></joint></model>", "no direction"),
        ("<physics><max_step_size>0</max_step_size></physics>", "max_step_size"),
        ("<include/>", "needs a <uri>"),
        ("<plugin/>", "needs filename and name"),
        ("<gravity>0 0</gravity>", "<gravity> needs 3 numbers"),
        ("<model name='m'><link name='l'/></model><model name='m'><link name='l'/></model>", "'m'"),
    ],
)  # fmt: skip
def test_wrong_worlds_are_refused_with_file_line_and_reason(inside: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence) as caught:
        read(inside)
    message = str(caught.value)
    assert message.startswith("f.sdf:") and "\n" not in message


def test_files_that_are_no_worlds() -> None:
    for text, sentence in (
        ("<a/>", "must be <sdf>"),
        ("<sdf version='x'/>", "1.10"),
        ("<sdf version='1.9'/>", "no <world>"),
    ):
        with pytest.raises(SdfError, match=sentence):
            read_world(text, "f.sdf", Diagnostics())


def test_a_missing_world_names_the_nearest_one() -> None:
    with pytest.raises(ResourceError, match=r"'lidar_rom\.sdf' was not found .* did you mean 'lidar_room\.sdf'"):
        World.load("lidar_rom.sdf")


def test_a_world_that_cannot_be_read(tmp_path: Path) -> None:
    path = tmp_path / "x.sdf"
    path.write_bytes(b"\xff\xfe<\x00s\x00d\x00f\x00/\x00>\x00")
    with pytest.raises(SdfError, match="no <world>"):
        World.load(path)


MODEL = (
    "<sdf version='1.9'><model name='{}'><pose>9 9 9 0 0 0</pose><link name='l'><pose>{} 0 0 0 "
    "0 0</pose></link></model></sdf>"
)


def shelf(folder: Path, name: str) -> None:
    (folder / name).mkdir(parents=True)
    (folder / name / "model.config").write_text(
        "<?xml version='1.0'?><model><sdf version='1.4'>old.sdf</sdf><sdf version='1.10'>new.sdf</sdf>"
        "<sdf version='1.9'>old.sdf</sdf></model>"
    )
    (folder / name / "old.sdf").write_text(MODEL.format("old", 1))
    (folder / name / "new.sdf").write_text(MODEL.format("new", 2))


def test_include_finds_models_on_the_resource_path_and_overrides(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shelf(tmp_path / "models", "cupboard")
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", f"/nowhere:{tmp_path / 'models'}")
    world, warnings = read(
        "<include><uri>model://cupboard</uri></include>"
        "<include><uri>model://cupboard</uri><name>mine</name><pose>1 2 3 0 0 0</pose><static>true</static>"
        "<plugin name='x' filename='y'/></include>"
    )
    first, second = world.models  # type: ignore[attr-defined]
    assert warnings == []
    assert (first.name, first.static, tuple(first.pose.position)) == ("new", False, (9, 9, 9))
    assert (second.name, second.static, tuple(second.pose.position)) == ("mine", True, (1, 2, 3))
    assert [plugin.name for plugin in second.plugins] == ["x"]
    assert second.links[0].pose.position[0] == 2


def test_an_included_file_is_read_by_the_rules_of_its_own_version(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "veteran").mkdir()
    (tmp_path / "veteran" / "model.sdf").write_text(
        "<sdf version='1.4'><model name='m'><link name='a'/><link name='b'><pose>0 0 0 0 0 "
        "1.5707963267948966</pose>"
        "</link><joint name='j' type='revolute'><parent>a</parent><child>b</child><axis><xyz>1 0 "
        "0</xyz></axis></joint>"
        "</model></sdf>"
    )
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path))
    world, _ = read("<include><uri>model://veteran</uri></include>")
    axis = world.models[0].joints[0].axis  # type: ignore[attr-defined]
    assert axis.direction == pytest.approx((0, -1, 0))


def test_a_world_is_found_on_the_resource_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "own.sdf").write_text("<sdf version='1.9'><world name='mine'/></sdf>")
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path))
    assert World.load("own.sdf").name == World.load("own").name == "mine"
    with pytest.raises(ResourceError, match=r"did you mean 'own\.sdf'"):
        World.load("owm.sdf")


def test_a_missing_include_is_skipped_with_a_warning_and_fuel_ground_planes_are_replaced() -> None:
    world, warnings = read(
        "<include><uri>model://two_wheel_robt</uri></include>"
        "<include><uri>https://fuel.gazebosim.org/1.0/OpenRobotics/models/Ground Plane</uri></include>"
    )
    assert [model.name for model in world.models] == ["ground_plane"]  # type: ignore[attr-defined]
    assert len(warnings) == 1
    assert warnings[0].startswith("f.sdf:3: ") and "did you mean 'two_wheel_robot'" in warnings[0]


def test_a_model_that_includes_itself_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "loop").mkdir()
    (tmp_path / "loop" / "model.sdf").write_text(
        "<sdf version='1.9'><model name='loop'><include><uri>model://loop</uri></include></model></sdf>"
    )
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path))
    with pytest.raises(SdfError, match="included inside itself"):
        read("<include><uri>model://loop</uri></include>")


def test_shapes_that_are_not_built_are_named(load_text: Callable[..., World]) -> None:
    world = load_text(
        "<model name='m'><static>1</static><link name='l'><visual name='v'><geometry><image><uri>a.png</uri></image>"
        "</geometry></visual></link></model>"
    )
    assert any("<image> geometry is not simulated" in warning for warning in world.warnings)


def body(inside: str, link: str = "") -> str:
    shape = "<geometry><sphere><radius>1</radius></sphere></geometry>"
    surface = f"<collision name='c'>{shape}<surface>{inside}</surface></collision>" if inside else ""
    return f"<model name='m'><link name='l'>{surface}{link}</link></model>"


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        (body("<friction><ode><mu>1</mu><mu2>0.5</mu2></ode></friction>"), "friction is the same in all directions"),
        (body("<friction><ode><mu>1</mu><mu2>1</mu2><slip1>0.1</slip1></ode></friction>"), "<slip1> 0.1"),
        (body("<contact><collide_without_contact>1</collide_without_contact></contact>"), "pushes what it touches"),
        (body("", "<kinematic>true</kinematic>"), "not held kinematic"),
        (body("", "<velocity_decay><linear>0.1</linear></velocity_decay>"), "<velocity_decay>"),
        (body("", "<particle_emitter name='p' type='box'/>"), "<particle_emitter> is not simulated"),
        (body("", "<projector name='p'/>"), "<projector> is not simulated"),
        (body("", "<inertial><fluid_added_mass/></inertial>"), "use the Hydrodynamics system"),
        ("<actor name='a'/>", "<actor> is not simulated"),
        ("<model name='m'><link name='l'/><gripper name='g'/></model>", "grippers"),
        ("<light name='x' type='sopt'/>", "did you mean 'spot'"),
    ],
)  # fmt: skip
def test_what_cannot_be_carried_is_said_once_and_the_rest_runs(inside: str, sentence: str) -> None:
    again = inside
    for one, other in (("'m'", "'n'"), ("'a'", "'b'"), ("'x'", "'y'")):
        again = again.replace(f"name={one}", f"name={other}")
    _, warnings = read(inside + again)
    assert 1 <= len(warnings) <= 2 and sentence in warnings[0] and warnings[0].startswith("f.sdf:3: ")


@pytest.mark.parametrize(
    "inside",
    [
        body("<friction><ode><mu>1</mu><mu2>1</mu2><fdir1>0 0 0</fdir1><slip1>0</slip1></ode></friction>"),
        body("<friction><ode><mu>1</mu><mu2>1</mu2><fdir1>1 0 0</fdir1></ode></friction>"),
        body("", "<velocity_decay><linear>0</linear></velocity_decay>"),
        "<wind><linear_velocity>0 0 0</linear_velocity></wind>",
    ],
)
def test_values_that_change_nothing_are_not_mentioned(inside: str) -> None:
    assert read(inside)[1] == []


@pytest.mark.parametrize(
    ("material", "rgba"),
    [
        ("", (0.7, 0.7, 0.7, 1)),
        ("<material><ambient>0 1 0 1</ambient></material>", (0, 1, 0, 1)),
        ("<material><ambient>0 1 0 1</ambient><diffuse>1 0 0</diffuse></material>", (1, 0, 0, 1)),
        ("<material><diffuse>1 2 -1 0.5</diffuse></material><transparency>0.5</transparency>", (1, 1, 0, 0.25)),
        ("<material><script><name>Gazebo/Blue</name></script></material>", (0, 0, 1, 1)),
        ("<material><script>Gazebo/RedTransparent</script></material>", (1, 0, 0, 0.5)),
        ("<material><script><name>Gazebo/Bricks</name></script><diffuse>0 1 0</diffuse></material>", (1, 1, 1, 1)),
        ("<material><script><name>Gazebo/Lanes_4</name></script></material>", (0.8, 0.8, 0.8, 1)),
        ("<material><script><name>Gazebo/BlueTransparent</name></script></material>", (0, 0, 1, 1)),
        ("<material><script><name>Gazebo/Grass</name></script><diffuse>0 1 0</diffuse></material>", (0, 1, 0, 1)),
    ],
)
def test_colours(material: str, rgba: tuple[float, ...]) -> None:
    shape = "<geometry><sphere><radius>1</radius></sphere></geometry>"
    visual = f"<visual name='v'>{shape}{material}</visual>"
    world, warnings = read(f"<model name='m'><static>1</static><link name='l'>{visual}</link></model>")
    assert world.models[0].links[0].visuals[0].rgba == pytest.approx(rgba) and warnings == []  # type: ignore[attr-defined]


def test_of_several_physics_profiles_the_default_one_counts() -> None:
    profile = "<physics name='{}' type='x'{}><max_step_size>{}</max_step_size></physics>"
    world, _ = read(profile.format("a", "", 0.002) + profile.format("b", " default='true'", 0.004))
    assert world.step_size_ns == 4_000_000  # type: ignore[attr-defined]


@pytest.mark.parametrize(("step", "said"), [("0.001", False), ("0.02", False), ("0.021", True), ("0.05", True)])
def test_a_step_that_is_too_long_for_wheels_is_named_with_its_line(step: str, said: bool) -> None:
    _, warnings = read(f"<physics type='x'>\n<max_step_size>{step}</max_step_size></physics>")
    assert len(warnings) == said
    if said:
        assert warnings[0].startswith(f"f.sdf:4: <max_step_size> is {step} s; above 0.02 s wheels slip")


def test_a_step_that_becomes_too_long_while_the_world_runs_is_named() -> None:
    world = World.load("empty.sdf")
    world.editor.set_physics(step_size=0.02)
    assert world.warnings == []
    world.editor.set_physics(step_size=0.03)
    assert len(world.warnings) == 1 and "<max_step_size> is 0.03 s" in world.warnings[0]


@settings(suppress_health_check=[HealthCheck.too_slow], deadline=None, max_examples=150)
@given(
    st.integers(0, len(ROOM) - 1),
    st.integers(1, 40),
    st.sampled_from(["", "x", "-", "<", "0", " ", "nan", "1e999"]),
)
def test_a_damaged_world_is_read_or_refused_with_a_sentence(start: int, length: int, replacement: str) -> None:
    text = ROOM[:start] + replacement + ROOM[start + length :]
    try:
        read_world(text, "room.sdf", Diagnostics())
    except SdfError as error:
        assert ":" in str(error) and "\n" not in str(error)
