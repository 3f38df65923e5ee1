"""YAML to messages: round trip with the output of `ros2 topic echo`, and one sentence for invalid values."""

import importlib
import string

import numpy as np
import pytest
import yaml
from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseArray, PoseStamped, PoseWithCovariance, Twist, TwistStamped
from hypothesis import given, settings
from hypothesis import strategies as st
from rcl_interfaces.msg import Log, ParameterDescriptor, ParameterEvent, ParameterValue
from rosidl_parser.definition import AbstractGenericString, AbstractNestedType, Array, BasicType, BoundedSequence
from sensor_msgs.msg import BatteryState, Image, Imu, JointState, JoyFeedbackArray, LaserScan, PointCloud2
from std_msgs.msg import Bool, Byte, Char, Empty, Float32, Float64, Int8, Int64, MultiArrayLayout, String, UInt64
from std_srvs.srv import SetBool
from trajectory_msgs.msg import JointTrajectory
from visualization_msgs.msg import Marker

from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.message_text import TextFormat, to_line, to_yaml
from gz_course.sim.ros.ros2.message_value import fill, parse_yaml

REAL_TYPES = [
    *(BatteryState, Bool, Byte, Char, Empty, Float32, Float64, Image, Imu, Int64, Int8, JointState, JointTrajectory),
    *(JoyFeedbackArray, LaserScan, Log, Marker, MultiArrayLayout, ParameterDescriptor, ParameterEvent, ParameterValue),
    *(PointCloud2, PoseArray, PoseStamped, PoseWithCovariance, SetBool.Request, String, Twist, UInt64),
]
TEXTS = st.one_of(
    st.text(st.characters(exclude_categories=["Cs"]), max_size=20),
    st.sampled_from(
        ["yes", "null", "~", "1.0", "0x1F", "2026-11-21", "- a", "a: b", "...", " x ", "#", "'", '"', "now"]
    ),
)


def values(kind):
    """Return a strategy for the values of a field of this type."""
    if isinstance(kind, AbstractNestedType):
        sizes = {"max_size": min(4, getattr(kind, "maximum_size", 4))}
        if isinstance(kind, Array):
            sizes = {"min_size": kind.size, "max_size": kind.size}
        return st.lists(values(kind.value_type), **sizes)
    if isinstance(kind, AbstractGenericString):
        return TEXTS
    if not isinstance(kind, BasicType):
        return messages(getattr(importlib.import_module(".".join(kind.namespaces)), kind.name))
    name = kind.typename
    if name == "boolean":
        return st.booleans()
    if name in ("float", "double"):
        return st.floats(width=32 if name == "float" else 64)
    if name == "octet":
        return st.binary(min_size=1, max_size=1)
    info = np.iinfo(name)
    return st.integers(int(info.min), int(info.max))


def messages(cls):
    """Return a strategy for the messages of a class."""
    names = list(cls.get_fields_and_field_types())
    return st.builds(cls, **dict(zip(names, map(values, cls.SLOT_TYPES), strict=True)))


def read(cls, text):
    message = cls()
    assert fill(message, text) == []
    return message


@pytest.mark.parametrize("cls", REAL_TYPES, ids=lambda cls: cls.__name__)
@settings(max_examples=12, deadline=None)
@given(data=st.data())
def test_what_echo_prints_can_be_published_again(cls, data):
    message = data.draw(messages(cls))
    whole = TextFormat(limit=None)
    again = read(cls, to_yaml(message, whole))
    assert repr(again) == repr(message), "NaN equals itself here"
    assert repr(read(cls, to_line(message))) == repr(message)
    assert to_yaml(again, whole) == to_yaml(message, whole)


def test_every_kind_of_field_is_drawn():
    """The types above have arrays, sequences, bounded ones, bytes, characters and nested messages."""
    kinds = {type(kind) for cls in REAL_TYPES for kind in cls.SLOT_TYPES}
    assert {Array, BoundedSequence, BasicType} <= kinds


@given(st.text(string.printable, max_size=40))
def test_any_text_is_a_message_or_one_sentence(text):
    for cls in (Twist, JointState):
        try:
            fill(cls(), text)
        except CommandError as error:
            assert len(str(error).splitlines()) == 1, error


@pytest.mark.parametrize(
    ("cls", "text", "value"),
    [
        (String, "data: yes", "yes"),
        (String, "data: 1.10", "1.10"),
        (String, "data:", ""),
        (Bool, "data: off", False),
        (Bool, "{data: 1}", True),
        (Float64, "data: 1e3", 1000.0),
        (Float64, "data: -.inf", float("-inf")),
        (Float64, "data: 3", 3.0),
        (Int8, "data: 0x10", 16),
        (Int8, "data: 2.0", 2),
        (Int64, "data: 9007199254740993", 9007199254740993),
        (Byte, "data: 7", b"\x07"),
        (Byte, "data: '7'", b"7"),
        (Float64, "", 0.0),
    ],
)
def test_a_value_is_read_as_what_its_field_is(cls, text, value):
    found = read(cls, text).data
    assert (type(found), found) == (type(value), value)


@pytest.mark.parametrize(
    ("cls", "text", "sentence"),
    [
        (Twist, "{linar: {x: 1}}", "Twist has no field 'linar', its fields: linear, angular; did you mean 'linear'?"),
        (Twist, "{linear: {w: 1}}", "'linear' of Twist has no field 'w', its fields: x, y, z"),
        (Twist, "linear: {x: fast}", "'linear.x' of Twist is a double, not 'fast'"),
        (Twist, "linear: 3", "'linear' of Twist is a geometry_msgs/Vector3: a dictionary, not '3'"),
        (Twist, "linear: {x: [1]}", "'linear.x' of Twist is a double, not a list"),
        (Twist, "linear: {x: }", "'linear.x' of Twist is a double, not empty"),
        (PoseArray, "poses: [{}, 3]", "'poses[1]' of PoseArray is a geometry_msgs/Pose: a dictionary, not '3'"),
        (PoseWithCovariance, "covariance: [1, 2]", "'covariance' of PoseWithCovariance has 36 items, not 2"),
        (ParameterDescriptor, "integer_range: [{}, {}]", "'integer_range' of ParameterDescriptor has at most 1 items"),
        (LaserScan, "ranges: [1, '...']", "'ranges' ends in '...': echo has left items out"),
        (LaserScan, "ranges: 1", "'ranges' of LaserScan is a list, not '1'"),
        (Int8, "data: 300", "'data' of Int8 is a number from -128 to 127 (int8), not '300'"),
        (Int8, "data: 1.5", "'data' of Int8 is a whole number (int8), not '1.5'"),
        (Int64, f"data: {'9' * 5000}", "'data' of Int64 is a whole number (int64), not '99999"),
        (Float32, "data: 1e39", "'data' of Float32 is a float of 32 bits, not '1e39'"),
        (Bool, "data: maybe", "'data' of Bool is a boolean (true or false), not 'maybe'"),
        (Byte, "data: 256", "'data' of Byte is a byte"),
        (String, "data: [a]", "'data' of String is a string, not a list"),
        (Empty, "x: 1", "Empty has no field 'x', its fields: none"),
    ],
)
def test_what_does_not_fit_is_named(cls, text, sentence):
    with pytest.raises(CommandError) as error:
        fill(cls(), text)
    assert str(error.value).startswith(f"Failed to populate field: {sentence}")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[1]", "The passed value needs to be a dictionary in YAML format, e.g. 'linear: ...'; it is a list"),
        ("fast", "The passed value needs to be a dictionary in YAML format, e.g. 'linear: ...'; it is 'fast'"),
        ("{linear: {x: 1", "The passed value is not YAML: line 2, column 1: "),
        ("linear: a: b", "The passed value is not YAML: line 1, column 10: "),
        ("a\x00b", "The passed value is not YAML: unacceptable character"),
        ("--- {}\n--- {}", "The passed value is not YAML: line 2, column 1: but found another document"),
        ("[" * 3000 + "]" * 3000, "The passed value "),
        ("*a", "The passed value is not YAML: line 1, column 1: found undefined alias"),
    ],
)
def test_what_is_no_dictionary_is_refused(text, sentence):
    with pytest.raises(CommandError) as error:
        fill(Twist(), text)
    assert str(error.value).startswith(sentence)


def test_a_list_that_holds_itself_is_refused():
    with pytest.raises(CommandError, match=r"'poses\[0\]' of PoseArray is a geometry_msgs/Pose"):
        fill(PoseArray(), "poses: &a [*a]")


def test_now_and_auto_are_the_time_of_sending():
    for text in ("{header: auto}", "{header: {stamp: now, frame_id: x}}"):
        message = TwistStamped()
        stamps = fill(message, text)
        for second in (1, 2):
            for stamp in stamps:
                stamp(Time(sec=second))
            assert message.header.stamp.sec == second
    with pytest.raises(CommandError, match="'twist' of TwistStamped is a geometry_msgs/Twist"):
        fill(TwistStamped(), "twist: now")


def test_nothing_is_no_document():
    assert parse_yaml("  # a comment\n") is None


def test_one_line_is_one_line():
    assert to_line(String(data="a\nb")) == '{data: "a\\nb"}'
    assert yaml.safe_load(to_line(LaserScan(ranges=[1.0] * 300)))["ranges"] == [1.0] * 300
