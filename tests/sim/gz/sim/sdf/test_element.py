"""XML as Gazebo reads it: as lenient as tinyxml2, with exact line numbers and one sentence for an error."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.sdf.element import Element, parse


def test_what_strict_parsers_refuse_is_read_with_its_lines() -> None:
    text = (
        "\n  \n<?xml version='1.0'?>\n<!-- a -- b\n gz service --req 'x' -->\n<sdf "
        "version='1.9'>\n<world name='w' gz:x='1'>\n<gz:policies/>\n</world></sdf>"
    )
    root = parse(text, "demo.sdf")
    world = root.find("world")
    assert world is not None and world.where == "demo.sdf:7"
    assert world.children[0].tag == "gz:policies" and world.children[0].line == 8


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("<sdf>\n<world>\n</sdf>", 3),
        ("<sdf>\n<world name=w/></sdf>", 2),
        ("<sdf>", 1),
        ("<sdf>&#0;</sdf>", 1),
    ],
)
def test_malformed_xml_is_one_sentence_with_the_line(text: str, line: int) -> None:
    with pytest.raises(SdfError) as caught:
        parse(text, "broken.sdf")
    message = str(caught.value)
    assert message.startswith(f"broken.sdf:{line}: ") and "well-formed" in message and "\n" not in message


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "f.sdf:1: this is no XML: it is empty, but an SDF or URDF begins with '<'"),
        ("model:\n  name: m", "f.sdf:1: this is no XML: it begins with 'model:', but an SDF or URDF begins with '<'"),
        (
            "<sdf>\n<!-- ground --\n<world/>\n</sdf>",
            "f.sdf:2: the comment that begins here with <!-- has no end; close it with -->",
        ),
        (
            "<sdf>\n<world>\n</sdf>",
            "f.sdf:3: this is not well-formed XML: mismatched tag, while <world> (opened on line 2) "
            "was open and </sdf> was "
            "met; write </world> before it",
        ),
        (
            "<sdf><a/><b></c></sdf>",
            "f.sdf:1: this is not well-formed XML: mismatched tag, while <b> (opened on line 1) was "
            "open and </c> was met; "
            "write </b> before it",
        ),
        (
            "<sdf>\n<world name=w/></sdf>",
            "f.sdf:2: this is not well-formed XML: not well-formed (invalid token), while <sdf> "
            "(opened on line 1) was open; "
            "check that every tag is closed and every attribute quoted",
        ),
    ],
)
def test_malformed_xml_says_what_to_do(text: str, sentence: str) -> None:
    with pytest.raises(SdfError) as caught:
        parse(text, "f.sdf")
    assert str(caught.value) == sentence


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("words <?xml version='1.0'?><sdf/>", 1),
        ("<!-- license -->\n<?xml version='1.0'?><sdf/>", 2),
        ("<sdf>\n<?xml version='1.0'?></sdf>", 2),
        ("<?xml?> words <?xml?><sdf/>", 1),
    ],
)
def test_a_declaration_stands_first_as_in_gazebo(text: str, line: int) -> None:
    with pytest.raises(SdfError) as caught:
        parse(text, "f.sdf")
    assert str(caught.value).startswith(f"f.sdf:{line}: the <?xml ...?> line must be the first")


@pytest.mark.parametrize(
    "text", ["two words\n<sdf><a/></sdf>", "\n <?xml?>\n<?xml?><sdf><a/></sdf>", "a < b <!-- <c> -->\n<sdf><a/></sdf>"]
)
def test_words_before_the_first_tag_are_ignored(text: str) -> None:
    root = parse(text, "f.sdf")
    assert (root.tag, root.line, root.children[0].tag) == ("sdf", text.count("\n") + 1, "a")


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        ("<size>1,1,1</size>", "; write blanks between numbers and a point before decimals, no commas"),
        ("<scale>0.5</scale>", "; write '0.5 0.5 0.5'"),
        ("<gravity>-9.8</gravity>", "; write '0 0 -9.8'"),
        ("<size>${length} 1 1</size>", "; this is xacro, which is expanded in files whose name ends with .xacro"),
        (
            "<size>1m 2m 3m</size>",
            "; write the number alone: lengths are in m, masses in kg, angles in rad, times in s",
        ),
        ("<size>1 2</size>", ""),
    ],
)
def test_numbers_that_are_none_come_with_advice(text: str, advice: str) -> None:
    with pytest.raises(SdfError) as caught:
        parse(text, "f.sdf").floats(3)
    assert str(caught.value).partition("'")[2].partition("'")[2] == advice


def test_an_entity_bomb_does_not_go_off() -> None:
    text = "<!DOCTYPE x [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;'>]><sdf>&b;</sdf>"
    with pytest.raises(SdfError):
        parse(text)


@given(st.text())
def test_any_text_is_read_or_refused_with_a_sentence(text: str) -> None:
    try:
        assert isinstance(parse(text, "f"), Element)
    except SdfError as error:
        assert str(error).startswith("f:")


@given(st.text(alphabet="<>/=\"' abc!-?\n", max_size=60))
def test_xml_like_noise_is_read_or_refused_with_a_sentence(text: str) -> None:
    try:
        parse(f"<sdf>{text}</sdf>", "f")
    except SdfError as error:
        assert str(error).startswith("f:")


@given(st.lists(st.floats(-1e6, 1e6), min_size=3, max_size=3))
def test_numbers_are_read_exactly(values: list[float]) -> None:
    element = parse(f"<a><size> {values[0]!r}\n{values[1]!r}\t{values[2]!r} </size></a>")
    assert element.vector("size", (0.0, 0.0, 0.0)) == tuple(values)


@pytest.mark.parametrize("text", ["1 2", "1 2 3 4", "one 2 3", "1 2 nan"])
def test_a_wrong_vector_is_blamed_where_it_stands(text: str) -> None:
    root = parse(f"<a>\n<size>{text}</size></a>", "f.sdf")
    with pytest.raises(SdfError, match=r"^f\.sdf:2: <size>"):
        root.vector("size", (0.0, 0.0, 0.0))


def test_poses_in_degrees_and_quaternions() -> None:
    root = parse(
        "<a><pose degrees='true'>1 2 3 0 0 90</pose></a>",
    )
    pose = root.children[0].pose()
    assert pose.yaw() == pytest.approx(math.pi / 2)
    quaternion = parse("<a><pose rotation_format='quat_xyzw'>1 2 3  0 0 2 2</pose></a>").children[0].pose()
    assert quaternion.is_close(pose)


@pytest.mark.parametrize("text", ["inf 0 0 0 0 0", "0 0 0 inf 0 0", "0 0 0", "x"])
def test_poses_that_are_none_are_refused(text: str) -> None:
    with pytest.raises(SdfError, match="<pose>"):
        parse(f"<a><pose>{text}</pose></a>").children[0].pose()


def test_booleans() -> None:
    root = parse("<a><x>TRUE</x><y>0</y><z>yes</z></a>", "f")
    assert root.flag("x", False) is True and root.flag("y", True) is False and root.flag("none", True) is True
    with pytest.raises(SdfError, match="true or false, got 'yes'"):
        root.flag("z", False)
