import json
import math

import pytest
from google.protobuf import json_format
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.msgs import message_class
from gz_course.sim.gz.msgs.any_pb2 import Any
from gz_course.sim.gz.msgs.bytes_pb2 import Bytes
from gz_course.sim.gz.msgs.color_pb2 import Color
from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.msgs.image_pb2 import Image
from gz_course.sim.gz.msgs.int64_pb2 import Int64
from gz_course.sim.gz.msgs.param_pb2 import Param
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.msgs.text import MessageTextError, from_text, to_json_line, to_text
from gz_course.sim.gz.msgs.twist_pb2 import Twist

# A negative zero is written as -0, which JSON readers parse as an integer without sign.
DOUBLES = st.floats().map(lambda value: value + 0.0)
# Python's JSON reader rejects the largest float32 numbers, which are rounded up when written.
SINGLES = st.floats(width=32).filter(lambda value: not 3.4e38 < abs(value) < math.inf).map(lambda value: value + 0.0)
TEXTS = st.text(st.characters(exclude_categories=["Cs"]))


def test_nested_messages_are_indented_and_an_empty_message_is_no_text():
    message = Twist()
    assert to_text(message) == ""
    message.linear.x = 1
    message.angular.SetInParent()
    assert to_text(message) == "linear {\n  x: 1\n}\nangular {\n}\n"


# The output of Gazebo's own tools, as compared by the conformance tests.
@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1.0, "1"),
        (-0.5, "-0.5"),
        (0.1, "0.1"),
        (0.1 + 0.2, "0.30000000000000004"),
        (1e22, "1e+22"),
        (-0.0, "-0"),
        (5e-324, "4.94065645841247e-324"),
        (math.inf, "inf"),
        (-math.inf, "-inf"),
        (math.nan, "nan"),
    ],
)
def test_doubles(value, text):
    assert to_text(Double(data=value)) == f"data: {text}\n"


@pytest.mark.parametrize(("value", "text"), [(0.1, "0.1"), (1 / 3, "0.333333343"), (3.4907e-40, "3.49070454e-40")])
def test_singles(value, text):
    assert to_text(Color(r=value)) == f"r: {text}\n"
    assert to_json_line(Color(r=value)) == f'{{"r":{text}}}'


def test_strings_are_escaped_to_ascii():
    assert (
        to_text(StringMsg(data="ä\x7f\x01\n'\"\\?€")) == 'data: "\\303\\244\\177\\001\\n\\\'\\"\\\\?\\342\\202\\254"\n'
    )
    assert to_text(Bytes(data=b"\xff\x00a")) == 'data: "\\377\\000a"\n'


def test_map_entries_are_sorted():
    message = Param()
    for key in ("b", "", "a"):
        message.params[key].int_value = len(key)
    keys = [line.strip() for line in to_text(message).splitlines() if "key" in line]
    assert keys == ['key: ""', 'key: "a"', 'key: "b"']
    assert list(json.loads(to_json_line(message))["params"]) == ["", "a", "b"]


def test_enums_have_names_and_unknown_ones_numbers():
    assert to_text(Image(pixel_format_type=3)) == "pixel_format_type: RGB_INT8\n"
    assert to_text(Image(pixel_format_type=99)) == "pixel_format_type: 99\n"
    assert to_json_line(Image(pixel_format_type=3)) == '{"pixelFormatType":"RGB_INT8"}'
    assert to_json_line(Image(pixel_format_type=99)) == '{"pixelFormatType":99}'


def test_json_follows_the_mapping_of_protobuf():
    assert to_json_line(Int64(data=2**53 + 1)) == '{"data":"9007199254740993"}'
    assert to_json_line(Double(data=1.0)) == '{"data":1}'
    assert to_json_line(Double(data=math.nan)) == '{"data":"NaN"}'
    assert to_json_line(Bytes(data=b"\xff\x00")) == '{"data":"/wA="}'
    assert to_json_line(Any(bool_value=True)) == '{"boolValue":true}'
    assert to_json_line(StringMsg(data="<ä\n\u2028>")) == '{"data":"\\u003cä\\n\\u2028\\u003e"}'


@given(DOUBLES, SINGLES, TEXTS, st.binary(), st.integers(-(2**63), 2**63 - 1))
def test_what_is_written_can_be_read_by_protobuf(double, single, text, data, integer):
    header = message_class("gz.msgs.Header")()
    header.data.add(key=text, value=[text, ""])
    for message in (Double(header=header, data=double), Color(r=single), Bytes(data=data), Int64(data=integer)):
        assert to_text(from_text(to_text(message), type(message))) == to_text(message)
        again = json_format.Parse(to_json_line(message), type(message)())
        assert to_text(again) == to_text(message)


@pytest.mark.parametrize(
    "text", ["linear: {x: 1.5}, angular: {z: 2}", "linear{x:1.5}angular<z:2>", "linear { x: 1.5 }\nangular { z: 2 }"]
)
def test_every_way_to_write_a_message_is_read(text):
    message = from_text(text, Twist)
    assert (message.linear.x, message.angular.z) == (1.5, 2)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("linaer: {x: 1}", "line 1, column 1: gz.msgs.Twist has no field 'linaer'; did you mean 'linear'?"),
        ("linear: {\n q: 1}", "line 2, column 2: gz.msgs.Vector3d has no field 'q'; its fields are header, x, y, z."),
        ("linear: {x: fast}", "line 1, column 13: Couldn't parse float: fast."),
        ("linear: {x: 1", "gz.msgs.Twist"),
        ("{", "gz.msgs.Twist"),
        ("linear: {x: 1} linear: {x: 2}", "gz.msgs.Twist"),
    ],
)
def test_what_cannot_be_read_is_one_sentence(text, words):
    with pytest.raises(MessageTextError) as caught:
        from_text(text, Twist)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@given(st.text())
def test_any_text_is_read_or_refused(text):
    try:
        from_text(text, Twist)
    except MessageTextError as error:
        assert "\n" not in str(error)
