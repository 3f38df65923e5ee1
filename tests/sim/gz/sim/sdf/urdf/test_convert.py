"""URDF robots: the SDF of links, joints and `<gazebo>` tags, and the messages about invalid ones."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.sdf.description import UNLIMITED, Model
from gz_course.sim.gz.sim.sdf.reader import read_model

MASS = "<inertial><mass value='{}'/><inertia ixx='.1' iyy='.1' izz='.1' ixy='0' ixz='0' iyz='0'/></inertial>"
BOX = "<geometry><box size='1 2 3'/></geometry>"
BASE = f"<link name='base'>{MASS.format(2)}</link>"
WHEEL = f"<link name='wheel'>{MASS.format(1)}</link>"


def joint(name: str, kind: str, parent: str, child: str, inside: str = "") -> str:
    return f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>{inside}</joint>"


def read(inside: str) -> tuple[Model, list[str]]:
    diagnostics = Diagnostics()
    text = f"<?xml version='1.0'?>\n<robot name='r'>\n{inside}\n</robot>"
    model = read_model(text, "r.urdf", diagnostics)
    assert isinstance(model, Model)
    return model, diagnostics.warnings


def test_a_link_on_a_fixed_joint_is_lumped_with_mass_shapes_and_sensors() -> None:
    model, warnings = read(
        BASE
        + f"<link name='arm'>{MASS.format(2)}<visual>{BOX}</visual><collision>{BOX}</collision></link>"
        + joint("j", "fixed", "base", "arm", f"<origin xyz='2 0 0' rpy='0 0 {math.pi / 2}'/>")
        + "<gazebo reference='arm'><sensor name='s' type='imu'><pose>1 0 0 0 0 0</pose></sensor></gazebo>"
    )
    (base,) = model.links
    assert warnings == []
    assert (base.inertial.mass, tuple(base.inertial.pose.position)) == (4.0, (1.0, 0.0, 0.0))
    # Two masses of 2 kg one metre from their common centre, along x.
    assert base.inertial.moments == pytest.approx((0.2, 4.2, 4.2, 0.0, 0.0, 0.0))
    assert [part.name for part in base.collisions] == ["base_fixed_joint_lump__arm_collision"]
    assert [part.name for part in base.visuals] == ["base_fixed_joint_lump__arm_visual"]
    assert base.visuals[0].pose.position == pytest.approx((2, 0, 0))
    assert base.sensors[0].pose.position == pytest.approx((2, 1, 0))
    assert base.sensors[0].pose.yaw() == pytest.approx(math.pi / 2)


def test_what_hangs_on_a_lumped_link_hangs_on_its_body() -> None:
    model, _ = read(
        "<link name='footprint'/>" + BASE + WHEEL
        + joint("up", "fixed", "footprint", "base", "<origin xyz='0 0 .5'/>")
        + joint("spin", "continuous", "base", "wheel", "<origin xyz='0 1 0'/><axis xyz='0 1 0'/>")
    )  # fmt: skip
    assert [link.name for link in model.links] == ["footprint", "wheel"]
    assert model.canonical_link == "footprint"
    spin = model.joints[0]
    assert (spin.kind, spin.parent, spin.child) == ("revolute", "footprint", "wheel")
    assert model.links[1].pose.position == pytest.approx((0, 1, 0.5))
    assert spin.axis is not None and spin.axis.direction == (0, 1, 0)
    assert (spin.axis.lower, spin.axis.upper) == (-UNLIMITED, UNLIMITED)


def test_lumped_links_are_placed_along_their_chain_and_numbered_by_the_names_of_their_joints() -> None:
    shape = f"<collision>{BOX}</collision>"
    quarter = f"<origin xyz='1 0 0' rpy='0 0 {math.pi / 2}'/>"
    model, _ = read(
        "".join(f"<link name='{name}'>{MASS.format(1)}{shape}</link>" for name in ("base", "one", "two", "three"))
        + joint("z", "fixed", "base", "one", quarter) + joint("y", "fixed", "one", "two", "<origin xyz='0 3 0'/>")
        + joint("a", "fixed", "base", "three")
    )  # fmt: skip
    parts = {part.name: part for part in model.links[0].collisions}
    lumped = "base_fixed_joint_lump__{}_collision_{}"
    assert list(parts) == ["base_collision", *(lumped.format(*each) for each in (("three", 1), ("one", 2), ("two", 3)))]
    assert parts[lumped.format("two", 3)].pose.position == pytest.approx((-2, 0, 0))
    assert parts[lumped.format("two", 3)].pose.yaw() == pytest.approx(math.pi / 2)


@pytest.mark.parametrize(("word", "kind"), [("preserveFixedJoint", "fixed"), ("disableFixedJointLumping", "revolute")])
def test_a_fixed_joint_can_be_kept(word: str, kind: str) -> None:
    model, _ = read(
        BASE + WHEEL + joint("j", "fixed", "base", "wheel") + f"<gazebo reference='j'><{word}>true</{word}></gazebo>"
    )
    assert [link.name for link in model.links] == ["base", "wheel"]
    assert model.joints[0].kind == kind
    if kind == "revolute":
        assert model.joints[0].axis is not None
        assert (model.joints[0].axis.lower, model.joints[0].axis.upper) == (0, 0)


def test_a_root_called_world_holds_the_robot() -> None:
    model, _ = read("<link name='world'/>" + BASE + joint("hold", "fixed", "world", "base", "<origin xyz='0 0 2'/>"))
    assert [link.name for link in model.links] == ["base"]
    assert (model.joints[0].kind, model.joints[0].parent) == ("fixed", "world")
    assert model.links[0].pose.position[2] == 2


def test_lumped_names_stay_as_frames_so_that_poses_can_name_them() -> None:
    model, _ = read(
        BASE + "<link name='eye'/>" + joint("j", "fixed", "base", "eye", "<origin xyz='0 0 3'/>")
        + "<gazebo reference='base'><sensor name='s' type='imu'><pose relative_to='eye'>1 0 0 0 0 0</pose></sensor>"
        "</gazebo>"
    )  # fmt: skip
    assert model.links[0].sensors[0].pose.position == pytest.approx((1, 0, 3))


def test_a_link_without_mass_goes_with_all_it_carries_and_the_warning_says_so() -> None:
    model, warnings = read(
        BASE + "<link name='hub'/>" + WHEEL + joint("a", "continuous", "base", "hub")
        + joint("b", "continuous", "hub", "wheel")
    )  # fmt: skip
    assert [link.name for link in model.links] == ["base"]
    assert len(warnings) == 1
    assert warnings[0].startswith("r.urdf:3: link 'hub' has no <inertial>, so Gazebo leaves it out")
    assert "with everything it carries (wheel)" in warnings[0]
    with pytest.raises(SdfError, match=r"r\.urdf:3: link 'hub' has no <inertial>.*nothing is left of robot 'r'"):
        read("<link name='hub'/>" + WHEEL + joint("b", "continuous", "hub", "wheel"))
    with pytest.raises(SdfError, match="link 'base' has no mass"):
        read(f"<link name='base'>{MASS.format(0)}</link>")


def test_gazebo_tags_reach_link_collision_and_joint() -> None:
    model, _ = read(
        f"<link name='base'>{MASS.format(1)}<collision>{BOX}</collision></link>" + WHEEL
        + joint("j", "continuous", "base", "wheel", "<dynamics damping='.5' friction='.25'/>")
        + "<gazebo reference='base'><mu1>0.3</mu1><turnGravityOff>true</turnGravityOff><selfCollide>1</selfCollide>"
        "</gazebo><gazebo reference='j'><springStiffness>7</springStiffness><springReference value='0.2'/></gazebo>"
        "<gazebo><static>true</static><plugin name='gz::sim::systems::DiffDrive' filename='x'/></gazebo>"
    )  # fmt: skip
    base = model.links[0]
    assert (base.collisions[0].mu, base.gravity, base.self_collide) == (0.3, False, True)
    axis = model.joints[0].axis
    assert axis is not None
    assert (axis.damping, axis.friction, axis.spring_stiffness, axis.spring_reference) == (0.5, 0.25, 7, 0.2)
    assert model.static and [plugin.name for plugin in model.plugins] == ["gz::sim::systems::DiffDrive"]


def test_a_block_for_collisions_and_one_for_visuals() -> None:
    model, _ = read(
        f"<link name='base'>{MASS.format(1)}<collision>{BOX}</collision><visual>{BOX}</visual></link>"
        "<gazebo reference='base'><collision><surface><friction><ode><mu>0.4</mu></ode></friction></surface>"
        "</collision><visual><material><diffuse>0 1 0 1</diffuse></material></visual></gazebo>"
    )
    assert model.links[0].collisions[0].mu == 0.4
    assert model.links[0].visuals[0].rgba == (0, 1, 0, 1)


def test_tags_that_gazebo_drops_silently_are_named() -> None:
    _, warnings = read(
        f"<link name='base'>{MASS.format(1)}<collision name='box'>{BOX}</collision></link><link name='eye'/>"
        + joint("neck", "fixed", "base", "eye")
        + "\n<gazebo reference='base'><mu1>0.3</mu1></gazebo>\n<gazebo reference='bse'><mu1>0.3</mu1></gazebo>"
        "\n<gazebo reference='neck'><sensor name='s' type='force_torque'/></gazebo>"
        "\n<gazebo reference='eye'><plugin name='p' filename='f'/></gazebo>\n<transmission/><ros2_control/>"
    )
    text = "\n".join(warnings)
    assert "r.urdf:5: <gazebo reference='bse'> names no link or joint of the robot" in text
    assert "did you mean 'base'" in text
    assert "r.urdf:6: joint 'neck' is fixed and lumped, so <sensor> of <gazebo reference='neck'> is lost" in text
    assert "r.urdf:7: a <plugin> in <gazebo reference='eye'> is not run" in text
    assert "r.urdf:3: <mu1> of <gazebo reference='base'> does not reach this <collision>" in text
    assert "r.urdf:8: <transmission> and <ros2_control> of robot 'r' describes hardware" in text


def test_limits_in_the_wrong_order_are_swapped_and_missing_ones_told() -> None:
    model, warnings = read(
        BASE + WHEEL + f"<link name='w2'>{MASS.format(1)}</link>"
        + joint("j", "revolute", "base", "wheel", "<limit lower='2' upper='-1' effort='3' velocity='1'/>")
        + joint("k", "revolute", "base", "w2", "<limit effort='3' velocity='1'/>")
    )  # fmt: skip
    axis = model.joints[0].axis
    assert axis is not None and (axis.lower, axis.upper, axis.effort) == (-1, 2, 3)
    assert any("lower 2 above upper -1; they are swapped" in warning for warning in warnings)
    assert any("'k' has no lower and upper, which means 0 and 0" in warning for warning in warnings)


def test_materials_by_name_and_in_place() -> None:
    model, warnings = read(
        "<material name='half'><color rgba='0.4 0 0 0.5'/></material>"
        f"<link name='base'>{MASS.format(1)}<visual>{BOX}<material name='half'/></visual>"
        f"<visual>{BOX}<material name='own'><color rgba='0 0.8 0 1'/></material></visual>"
        f"<visual>{BOX}<material name='hlf'/></visual><collision>{BOX}</collision></link>"
    )
    colours = [visual.rgba for visual in model.links[0].visuals]
    assert colours[0] == pytest.approx((0.5, 0, 0, 0.5)) and colours[1] == pytest.approx((0, 1, 0, 1))
    assert len(warnings) == 1 and "material 'hlf' is not defined" in warnings[0] and "'half'" in warnings[0]


def test_a_shape_without_geometry_is_left_out_and_a_mass_without_inertia_gets_one() -> None:
    model, warnings = read(
        f"<link name='base'>{MASS.format(5).replace('.1', '0')}<visual/>\n"
        "<collision><geometry><cone/></geometry></collision></link>"
    )
    assert (model.links[0].visuals, model.links[0].collisions) == ([], [])
    assert model.links[0].inertial.moments == pytest.approx((2e-4, 2e-4, 2e-4, 0, 0, 0))
    text = "\n".join(warnings)
    assert "r.urdf:3: <visual> has no <geometry> with one of <box>" in text
    assert "r.urdf:4: <collision> has no <geometry>" in text
    assert "link 'base' has a mass but no moment of inertia" in text


@pytest.mark.parametrize(
    ("shape", "words"),
    [
        ("<box>0.1 0.1 0.1</box>", "<box> needs the attribute size, as in <box size='0.1 0.1 0.1'/>"),
        ("<cylinder radius='1'/>", "<cylinder> needs the attribute length, as in"),
        ("<mesh/>", "<mesh> needs the attribute filename"),
    ],
)
def test_a_shape_without_its_measures_is_left_out(shape: str, words: str) -> None:
    bad = f"<visual><geometry>{shape}</geometry></visual>"
    model, warnings = read(BASE.replace("</link>", f"{bad}<collision>{BOX}</collision></link>"))
    (text,) = warnings
    assert words in text and text.endswith("; this <visual> is left out")
    assert (model.links[0].visuals, len(model.links[0].collisions)) == ([], 1)


def test_a_limit_that_is_the_largest_number_is_none() -> None:
    limit = "<limit lower='-1.79769e+308' upper='1.79769e+308' effort='1.79769e+308' velocity='1'/>"
    model, warnings = read(BASE + WHEEL + joint("j", "revolute", "base", "wheel", limit))
    axis = model.joints[0].axis
    assert axis is not None and warnings == []
    assert (axis.lower, axis.upper) == (-UNLIMITED, UNLIMITED)


def test_the_material_of_a_gazebo_tag_counts_more_than_that_of_the_urdf() -> None:
    visual = f"<visual>{BOX}<material name='m'><color rgba='0.8 0 0 1'/></material></visual>"
    link = f"<link name='base'>{MASS.format(1)}{visual}</link>"
    text = link + "<gazebo reference='base'><material>Gazebo/{}</material></gazebo>"
    assert read(text.format("Blue"))[0].links[0].visuals[0].rgba == (0, 0, 1, 1)
    assert read(text.format("Plaid"))[0].links[0].visuals[0].rgba == pytest.approx((1, 0, 0, 1))


def test_a_floating_joint_leaves_its_link_free() -> None:
    model, warnings = read(BASE + WHEEL + joint("j", "floating", "base", "wheel", "<origin xyz='0 0 4'/>"))
    assert model.joints == [] and model.links[1].pose.position[2] == 4
    assert "link 'wheel' moves freely" in warnings[0]


def test_a_mesh_is_found_in_a_ros_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "share" / "robot_description" / "meshes"
    folder.mkdir(parents=True)
    (folder / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    mesh = "<geometry><mesh filename='package://robot_description/meshes/{}' scale='2 2 2'/></geometry>"
    model, warnings = read(
        f"<link name='base'>{MASS.format(1)}<visual>{mesh.format('a.obj')}</visual><visual>\n"
        f"{mesh.format('b.obj')}</visual><collision>{BOX}</collision></link>"
    )
    assert len(model.links[0].visuals) == 1 and model.links[0].visuals[0].geometry.kind == "mesh"
    assert len(warnings) == 1
    assert warnings[0].startswith("r.urdf:4: 'package://robot_description/meshes/b.obj' was not found")


def test_words_urdf_does_not_have_are_named() -> None:
    _, warnings = read(f"<link name='base'>{MASS.format(1)}<colision/></link><foo:bar/>")
    assert len(warnings) == 1 and "did you mean 'collision'" in warnings[0]


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        ("", "r.urdf:2: robot 'r' has no <link>"),
        ("<link name='world'/>", "has no link but 'world'"),
        (BASE + BASE, "link 'base' is already there"),
        (BASE + WHEEL, "'base' and 'wheel' both have no parent; a URDF has one root"),
        (BASE + WHEEL + joint("a", "fixed", "base", "whel"), "names link 'whel'.*did you mean 'wheel'"),
        (BASE + WHEEL + joint("a", "fixd", "base", "wheel"), "type 'fixd'; did you mean 'fixed'"),
        (BASE + WHEEL + joint("a", "revolute", "base", "wheel"), "needs <limit lower upper effort velocity>"),
        (BASE + WHEEL + joint("a", "fixed", "base", "base"), "connects link 'base' with itself"),
        (BASE + WHEEL + 2 * joint("a", "fixed", "base", "wheel"), "joint 'a' is already there"),
        (BASE + WHEEL + joint("a", "fixed", "base", "wheel") + "\n" + joint("b", "fixed", "base", "wheel"),
         "r.urdf:4: link 'wheel' is the child of joint 'b' and of joint 'a'.*one parent"),
        (BASE + WHEEL + joint("a", "fixed", "base", "wheel") + joint("b", "fixed", "wheel", "base"),
         "circle: (base -> wheel -> base|wheel -> base -> wheel)"),
        ("<link name='root'/>" + BASE + WHEEL + joint("a", "fixed", "base", "wheel")
         + joint("b", "fixed", "wheel", "base"), "circle"),
        ("<link name='base'><inertial><mass value='nan'/><inertia ixx='1'/></inertial></link>", "needs the attribute"),
        (BASE.replace("'2'", "'nan'"), "value of <mass> must be a finite number, got 'nan'"),
        (BASE.replace("'2'", "'1e300'"), "value of <mass> must be between -1e.20 and 1e.20, got '1e300'"),
        (BASE.replace("'2'", "'${m}'"), "got '\\$.m.'; run xacro on the file first"),
        ("<link name='base'><inertial/></link>", "<inertial> needs <mass>"),
        (BASE.replace("</link>", "<visual><geometry><box size='1 1'/></geometry></visual></link>"), "3 finite numbers"),
        (BASE.replace("</link>", "<visual><geometry><box size='1 1 -1'/></geometry></visual></link>"), "greater than"),
        (BASE.replace("</link>", "<visual><origin rpy='0 0'/><geometry><box size='1 1 1'/></geometry></visual></link>"),
         "rpy of <origin> must be 3 finite numbers, got '0 0'"),
        ("<link/>", "<link> needs a name"),
        ("<xacro:macro/>", "<xacro:macro> is for xacro, which was not run"),
        (BASE + WHEEL + joint("a", "continuous", "base", "wheel", "<axis xyz='0 0 0'/>"), "no direction"),
        (BASE + WHEEL + joint("a", "continuous", "base", "wheel", "<mimic joint='q'/>"), "names joint 'q'"),
    ],
)  # fmt: skip
def test_wrong_robots_are_refused_with_file_line_and_reason(inside: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence) as caught:
        read(inside)
    assert str(caught.value).startswith("r.urdf:") and "\n" not in str(caught.value)


def test_a_robot_needs_a_name() -> None:
    with pytest.raises(SdfError, match="<robot> needs a name"):
        read_model("<robot/>", "r.urdf", Diagnostics())


def test_a_chain_of_thousands_of_links_is_read() -> None:
    count = 1500
    links = "".join(f"<link name='l{i}'>{MASS.format(1)}</link>" for i in range(count))
    joints = "".join(joint(f"j{i}", "fixed", f"l{i - 1}", f"l{i}") for i in range(1, count))
    model, _ = read(links + joints)
    assert len(model.links) == 1 and model.mass() == pytest.approx(count)


ROBOT = (
    "<robot name='r'><material name='red'><color rgba='1 0 0 1'/></material>" + BASE
    + f"<link name='arm'>{MASS.format(2)}<visual>{BOX}<material name='red'/></visual>"
    + f"<collision>{BOX}</collision></link>"
    + joint("j", "fixed", "base", "arm", "<origin xyz='2 0 0' rpy='0 0 1'/>") + WHEEL
    + joint("k", "revolute", "arm", "wheel", "<limit lower='-1' upper='1' effort='3' velocity='1'/>")
    + "<gazebo reference='arm'><mu1>0.5</mu1><sensor name='s' type='imu'/></gazebo></robot>"
)  # fmt: skip


@settings(suppress_health_check=[HealthCheck.too_slow], deadline=None, max_examples=200)
@given(
    st.integers(0, len(ROBOT) - 1),
    st.integers(0, 30),
    st.sampled_from(["", "x", "<", "'", "nan", "1e999", "-1", "base", "world", "wheel", "fixed"]),
)
def test_a_damaged_robot_is_read_or_refused_with_a_sentence(start: int, length: int, put: str) -> None:
    try:
        read_model(ROBOT[:start] + put + ROBOT[start + length :], "r.urdf", Diagnostics(strict=True))
    except SdfError as error:
        assert str(error).startswith("r.urdf:") and "\n" not in str(error)
