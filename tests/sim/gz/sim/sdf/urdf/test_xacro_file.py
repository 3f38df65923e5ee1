"""xacro files: expansion, messages with the original file and line, and limits of time and memory."""

from __future__ import annotations

from pathlib import Path

import pytest

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.sdf.description import Model
from gz_course.sim.gz.sim.sdf.element import parse
from gz_course.sim.gz.sim.sdf.reader import read_model, read_world_file
from gz_course.sim.gz.sim.sdf.resources import read_text
from gz_course.sim.gz.sim.sdf.urdf.xacro_file import expand, restore_places

PARTS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="wheel" params="side r:=0.05">
    <link name="${side}_wheel">
      <inertial><mass value="0.2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
      <collision><geometry><sphere radius="${r}"/></geometry></collision>
    </link>
    <joint name="${side}_joint" type="continuous">
      <parent link="base"/>
      <child link="${side}_wheel"/>
    </joint>
  </xacro:macro>
</robot>
"""
ROBOT = """<?xml version="1.0"?>
<robot name="cart" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="size" default="0.3"/>
  <xacro:property name="mass" value="${2 * 1.5}"/>
  <xacro:include filename="parts.xacro"/>
  <link name="base">
    <inertial><mass value="${mass}"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="$(arg size) ${mass / 10} 0.1"/></geometry></collision>
  </link>
  <xacro:wheel side="left"/>
  <xacro:wheel side="right" r="0.1"/>
</robot>
"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "parts.xacro").write_text(PARTS)
    (tmp_path / "cart.urdf.xacro").write_text(ROBOT)
    return tmp_path / "cart.urdf.xacro"


def test_a_robot_of_macros_arguments_and_expressions(robot: Path) -> None:
    model = read_model(read_text(robot), str(robot), Diagnostics())
    assert isinstance(model, Model)
    assert [link.name for link in model.links] == ["base", "left_wheel", "right_wheel"]
    assert model.mass() == pytest.approx(3.4)
    assert model.links[0].collisions[0].geometry.size == pytest.approx((0.3, 0.3, 0.1))
    assert model.links[2].collisions[0].geometry.size[0] == pytest.approx(0.2)


def test_every_element_knows_where_it_was_written(robot: Path) -> None:
    root = parse(expand(robot), str(robot))
    restore_places(root)
    base, left = root.all("link").__next__(), root.children[1]
    assert (base.where, left.where) == (f"{robot}:6", f"{robot.parent / 'parts.xacro'}:3")
    assert not any("_" in key[:1] for element in (root, base, left, *left.children) for key in element.attributes)


@pytest.mark.parametrize("files", ["", "7", "[", "[1]", '["a"]'])
def test_marks_written_by_hand_do_no_harm(files: str) -> None:
    root = parse(f"<robot _files_='{files}' _place_='9:1'><link _place_='0:x'/><link _place_=''/></robot>", "f.urdf")
    restore_places(root)
    assert [element.where for element in (root, *root.children)] == ["f.urdf:1"] * 3


def test_a_message_about_a_macro_names_the_line_in_the_macro(robot: Path) -> None:
    (robot.parent / "parts.xacro").write_text(PARTS.replace('radius="${r}"', 'radius="${r}m"'))
    with pytest.raises(SdfError, match=r"parts\.xacro:5: radius of <sphere> must be a finite number, got '0\.05m'"):
        read_model(read_text(robot), str(robot), Diagnostics())


def test_arguments_are_passed(robot: Path) -> None:
    assert 'size="0.7 0.3' in expand(robot, {"size": "0.7"})


def test_a_world_may_be_xacro_and_include_xacro(robot: Path) -> None:
    (robot.parent / "room.sdf.xacro").write_text(
        "<sdf version='1.10' xmlns:xacro='x'><xacro:property name='n' value='2'/><world name='w'>"
        "<include><uri>cart.urdf.xacro</uri><pose>${n + 1} 0 0 0 0 0</pose></include></world></sdf>"
    )
    world = read_world_file(robot.parent / "room.sdf.xacro", Diagnostics())
    assert (world.models[0].name, world.models[0].pose.position[0]) == ("cart", 3.0)


def test_find_asks_the_ament_index(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    index = robot.parent / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "cart_parts").touch()
    (robot.parent / "share" / "cart_parts").mkdir()
    (robot.parent / "parts.xacro").rename(robot.parent / "share" / "cart_parts" / "parts.xacro")
    robot.write_text(ROBOT.replace("parts.xacro", "$(find cart_parts)/parts.xacro"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(robot.parent))
    assert "right_wheel" in expand(robot)
    monkeypatch.setenv("AMENT_PREFIX_PATH", "/nowhere")
    with pytest.raises(SdfError, match=r":5: xacro: there is no ROS package 'cart_parts'; is its prefix in AMENT_PREF"):
        expand(robot)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('<xacro:wheel side="left"/>', '<xacro:whel side="left"/>', ":10: xacro: unknown macro name: xacro:whel"),
        ('<xacro:wheel side="left"/>', "<xacro:wheel/>", r":10: xacro: Undefined parameters \[side\]"),
        ('side="left"', 'sid="left"', ':10: xacro: Invalid parameter "sid"'),
        ("${mass / 10}", "${mas / 10}", ":8: xacro: name 'mas' is not defined"),
        ("${mass / 10}", "${mass / 0}", ":8: xacro: float division by zero"),
        ("$(arg size)", "$(arg siz)", ":8: xacro: Undefined substitution argument siz; declare it with <xacro:arg"),
        ("parts.xacro", "prts.xacro", r":5: xacro: the file '.*prts\.xacro' cannot be read \(No such file"),
        ("parts.xacro", "cart.urdf.xacro", "calls itself without end"),
        ("</link>", "</lnk>", r":9: xacro: this is not well-formed XML \(mismatched tag\)"),
        ('<xacro:wheel side="left"/>', '<xacro:if value="perhaps"/>', ":10: xacro: .*perhaps.* not a boolean"),
        (
            '<xacro:wheel side="left"/>',
            '<xacro:macro name="a"><xacro:a/></xacro:macro><xacro:a/>',
            ":10: .*without end",
        ),
        ("${mass / 10}", "${[0] * 10**10}", ":8: xacro"),
    ],
)
def test_what_xacro_cannot_do_is_one_sentence(robot: Path, old: str, new: str, sentence: str) -> None:
    robot.write_text(ROBOT.replace(old, new, 1))
    with pytest.raises(SdfError, match=sentence) as caught:
        expand(robot)
    assert str(caught.value).startswith(str(robot.parent)) and "\n" not in str(caught.value)


def test_an_expression_without_end_is_stopped(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gz_course.sim.gz.sim.sdf.urdf.xacro_file._SECONDS", 1.0)
    robot.write_text(ROBOT.replace("${mass / 10}", "${9**9**9}"))
    with pytest.raises(SdfError, match=r"cart\.urdf\.xacro: xacro did not end within 1 s"):
        expand(robot)


def test_a_missing_file_and_a_missing_xacro(tmp_path: Path) -> None:
    with pytest.raises(SdfError, match=r"none\.xacro: xacro: the file .* cannot be read"):
        expand(tmp_path / "none.xacro")
