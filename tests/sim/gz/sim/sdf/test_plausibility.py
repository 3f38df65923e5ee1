"""Valid but implausible SDF causes one warning with file and line; ordinary files cause none."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.sdf.reader import read_world
from gz_course.sim.gz.sim.world import World
from gz_course.tests.sim.gz.sim.sdf.shapes_on_disk import write_obj

SOLID = "<collision name='c'><geometry><box><size>1 1 1</size></box></geometry></collision>"
SEEN = "<visual name='v'><geometry><box><size>1 1 1</size></box></geometry></visual>"
WEIGHT = "<inertial><mass>1</mass></inertial>"
WEIGHTLESS = "<inertial><mass>1</mass><inertia><ixx>1e-5</ixx><iyy>1e-5</iyy><izz>1e-5</izz></inertia></inertial>"
JOINT = "<joint name='j' type='{}'><parent>a</parent><child>b</child>{}</joint>"
AXIS = "<axis><xyz>0 1 0</xyz>{}</axis>"


def warnings(inside: str) -> list[str]:
    diagnostics = Diagnostics()
    read_world(f"<sdf version='1.10'><world name='w'>\n{inside}\n</world></sdf>", "f.sdf", diagnostics)
    return diagnostics.warnings


def pair(joint: str, b: str = "") -> str:
    return f"<model name='m'><link name='a'/><link name='b'>{b}</link>\n{joint}</model>"


def shaped(shape: str) -> str:
    return (
        f"<model name='m'><link name='l'><collision name='c'><geometry>\n{shape}</geometry></collision></link></model>"
    )


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        (
            f"<model name='m'>\n<pose>0 0 0.5 0 0 90</pose><link name='l'>{SOLID}</link></model>",
            "f.sdf:3: <pose> turns by 90 rad, which is more than once round; angles are in radians: 90 degrees are "
            "1.5708; or write <pose degrees='true'>",
        ),
        (
            pair(JOINT.format("revolute", AXIS.format("<limit><lower>-90</lower><upper>45</upper></limit>"))),
            "f.sdf:3: the limits of joint 'j' are -90 and 45 rad; were degrees meant? 45 degrees are 0.7854 rad",
        ),
        (
            pair(JOINT.format("revolute", "")),
            "f.sdf:3: joint 'j' is revolute and has no <axis>, so it moves about or along z; add for example "
            "<axis><xyz>0 1 0</xyz></axis>",
        ),
        (
            shaped("<box>2 2 2</box>"),
            "f.sdf:3: the text '2 2 2' in <box> is ignored; what can stand there is <size>",
        ),
        (
            shaped("<cylinder/>"),
            "f.sdf:3: <cylinder> has no <radius> and no <length>, so it has the default size; add what is missing",
        ),
        (
            pair(JOINT.format("continuous", AXIS.format("")), SOLID).replace("<link name='b'>", "\n<link name='b'>"),
            "f.sdf:3: link 'b' has no <inertial>, so it has a mass of 1 kg and moments of inertia of 1 kg m^2 (SDF's "
            "default), and joint 'j' moves slowly; state both or write <inertial auto='true'/>",
        ),
        (
            pair(JOINT.format("continuous", AXIS.format("")), SOLID + WEIGHTLESS).replace(
                "<link name='b'>", "\n<link name='b'>"
            ),
            "f.sdf:3: link 'b' has almost no moment of inertia: 1e-05 kg m^2, where its mass and shape make 0.17; "
            "joint 'j' then has next to nothing to turn, and physics can fail (the robot explodes); "
            "state that of its shape in <inertia>",
        ),
        (
            f"\n<model name='m'><link name='l'>{SEEN}</link></model>",
            "f.sdf:3: model 'm' can be seen but has no <collision>, so it falls through the ground; add one, or write "
            "<static>true</static>",
        ),
        (
            "<model name='m'><link name='l'><sensor name='s' type='ray'><topic>scan</topic>\n"
            "<plugin name='p' filename='libgazebo_ros_ray_sensor.so'/></sensor></link></model>",
            "f.sdf:3: plugin 'libgazebo_ros_ray_sensor.so' inside of sensor 's' is ignored with all its parameters, it "
            "is of Gazebo Classic; a system of the world publishes the sensor: <topic> and "
            "<gz_frame_id> belong directly "
            "into <sensor>",
        ),
        (
            "<model name='m'><static>1</static><link name='l'><sensor name='s' type='camera'>\n"
            "<update_rate>-5</update_rate></sensor></link></model>",
            "f.sdf:3: <update_rate> of sensor 's' is -5 Hz, so it measures at every step; write how "
            "often a second, or 0 "
            "for every step",
        ),
        (
            f"<model name='m'><link name='l'>{SOLID}{SEEN}</link></model>".replace(
                "</visual>", "<material>\n<diffuse>255 51 0</diffuse></material></visual>"
            ),
            "f.sdf:3: <diffuse> is 255 51 0, but colours go from 0 to 1; write '1 0.2 0 1'",
        ),
        (
            pair(JOINT.format("fixed", "") + "\n<link name='caster'/>"),
            "f.sdf:4: no <joint> connects link 'caster' with the rest of model 'm', so it falls off; "
            "add one, for example "
            "of type fixed",
        ),
    ],
)
def test_it_is_said_with_file_and_line(inside: str, sentence: str) -> None:
    assert sentence in warnings(inside)


@pytest.mark.parametrize(
    "inside",
    [
        f"<model name='m'><pose degrees='true'>0 0 0.5 0 0 90</pose><link name='l'>{SOLID}</link></model>",
        f"<model name='m'><pose>100 200 300 3.14 0 6.28</pose><link name='l'>{SOLID}</link></model>",
        f"<model name='m'><pose rotation_format='quat_xyzw'>9 9 9 0 0 0 8</pose><link name='l'>{SOLID}</link></model>",
        pair(JOINT.format("revolute", AXIS.format("<limit><lower>-1e16</lower><upper>1e16</upper></limit>"))),
        pair(JOINT.format("revolute", AXIS.format("<limit><lower>-100</lower><upper>100</upper></limit>"))),
        pair(JOINT.format("prismatic", AXIS.format("<limit><lower>0</lower><upper>30</upper></limit>"))),
        pair(JOINT.format("fixed", "")),
        pair(JOINT.format("continuous", AXIS.format("")), SOLID + WEIGHT),
        pair(JOINT.format("continuous", AXIS.format("")), SOLID + "<inertial auto='true'/>"),
        pair(JOINT.format("fixed", ""), SOLID),
        f"<model name='m'><static>true</static><link name='l'>{SEEN}</link></model>",
        f"<model name='m'><link name='l'><gravity>false</gravity>{SEEN}</link></model>",
        f"<model name='m'><link name='l'>{SEEN}</link><joint name='j' type='fixed'><parent>world</parent>"
        "<child>l</child></joint></model>",
        f"<model name='m'><link name='l'>{SEEN}</link></model><joint name='j' type='fixed'><parent>world</parent>"
        "<child>m::l</child></joint>",
    ],
)
def test_what_people_mean_is_silent(inside: str) -> None:
    assert warnings(inside) == []


def test_a_version_there_is_not() -> None:
    diagnostics = Diagnostics()
    read_world("<sdf version='2.0'><world name='w'/></sdf>", "f.sdf", diagnostics)
    assert diagnostics.warnings == [
        "f.sdf:1: there is no version 2.0 of SDF, the file is read as 1.12; write version='1.12'"
    ]


def test_a_thing_that_moves_and_is_long_was_drawn_in_millimetres(tmp_path: Path) -> None:
    for length in (19, 300):
        write_obj(tmp_path / "box.obj", ((0, 0), (length, 0), (length, 2), (0, 2)))
        text = f"<geometry><mesh><uri>{tmp_path}/box.obj</uri></mesh></geometry>"
        found = warnings(f"<model name='m'><link name='l'>\n<collision name='c'>{text}</collision></link></model>")
        sentence = "f.sdf:3: the mesh box.obj is 300 m long; if its file is in millimetres, add to <mesh>: "
        assert found == ([f"{sentence}<scale>0.001 0.001 0.001</scale>"] if length == 300 else [])


def test_a_word_at_the_wrong_place_is_sent_home() -> None:
    (found,) = warnings("<visual name='v'/>")
    assert found == "f.sdf:2: <world> has no element <visual>, it is ignored; it belongs into <link>"


def test_angles_of_a_urdf() -> None:
    inertial = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"
    links = "".join(f"<link name='{name}'>{inertial}</link>" for name in "ab")
    world = World.load("empty.sdf")
    world.editor.spawn(
        f"<robot name='r'>{links}\n<joint name='j' type='fixed'><origin xyz='0 0 1' rpy='0 180 0'/>"
        "<parent link='a'/><child link='b'/></joint></robot>"
    )
    assert world.warnings == [
        "<spawned>:2: <origin> turns by 180 rad, which is more than once round; angles are in radians: 180 degrees are "
        "3.1416"
    ]


@given(st.lists(st.floats(-1e3, 1e3), min_size=3, max_size=3))
def test_only_more_than_a_turn_is_doubted(angles: list[float]) -> None:
    inside = f"<model name='m'><pose>0 0 0 {' '.join(map(repr, angles))}</pose><link name='l'/></model>"
    assert bool(warnings(inside)) == (max(map(abs, angles)) > 2.0 * math.pi + 0.2168146928)


def test_strict_loading_refuses_what_is_lost_but_no_doubt(caplog: pytest.LogCaptureFixture) -> None:
    for shape, refused in (("<sphere/>", False), ("<box>1 1 1<size>1 1 1</size></box>", True)):
        diagnostics = Diagnostics(strict=True)
        caplog.clear()
        read_world(f"<sdf version='1.10'><world name='w'>{shaped(shape)}</world></sdf>", "f.sdf", diagnostics)
        assert diagnostics.warnings
        if refused:
            with pytest.raises(SdfError, match="strict loading refuses"):
                diagnostics.refuse()
        else:
            assert "<sphere>" in caplog.text  # logged at once nevertheless
            diagnostics.refuse()
