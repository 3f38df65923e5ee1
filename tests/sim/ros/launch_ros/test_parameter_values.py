"""The types of parameter values as a table, and as received by a real node."""

import json
import math
import os
import sys
from array import array

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.ros.launch import LaunchContext
from gz_course.sim.ros.launch.substitutions import LaunchConfiguration, TextSubstitution
from gz_course.sim.ros.launch_ros.parameter_descriptions import Parameter, ParameterValue
from gz_course.sim.ros.launch_ros.parameter_values import (
    ParameterTypeError,
    as_argument,
    as_file,
    evaluate_value,
    flattened,
)
from gz_course.tests import warm_process


def text(value):
    return TextSubstitution(text=value)


def evaluated(value, **configurations):
    context = LaunchContext()
    context.launch_configurations.update(configurations)
    return evaluate_value(context, "p", value)


TABLE = [
    ("5", "5"),
    ("true", "true"),
    ("", ""),
    (True, True),
    (3, 3),
    (0.5, 0.5),
    ([1, 2], [1, 2]),
    ((1, 2.5), [1.0, 2.5]),
    ([True, False], [True, False]),
    (["a", "1", "true"], ["a", "1", "true"]),
    (text("5"), 5),
    (text("5."), 5.0),
    (text("off"), False),
    (text(""), ""),
    (text("a b"), "a b"),
    (text("'5'"), "5"),
    (text("[1, 2]"), [1, 2]),
    (text("['1', 'x']"), ["1", "x"]),
    ([text("4"), "2"], 42),
    (["a", text("b")], "ab"),
    ([[text("1")], [text("2")]], [1, 2]),
    ([[text("a")], "b"], ["a", "b"]),
    ([["1", text("5")], [text("2")]], [15, 2]),
    (ParameterValue(text("5"), value_type=str), "5"),
    (ParameterValue([text("<robot>: "), text("[")], value_type=str), "<robot>: ["),
    (ParameterValue(text("5"), value_type=float), 5.0),
    (ParameterValue(text("5"), value_type=int), 5),
    (ParameterValue(True, value_type=bool), True),
    (ParameterValue(text("[1, 2]"), value_type=list[float]), [1.0, 2.0]),
    (ParameterValue([1, 2], value_type=list[int]), [1, 2]),
    (ParameterValue([1, 2.5], value_type=list[float]), [1.0, 2.5]),
    (ParameterValue(text("5")), 5),
    (ParameterValue(3.0, value_type=float), 3.0),
]


@pytest.mark.parametrize(("given_value", "value"), TABLE)
def test_the_table(given_value, value):
    result = evaluated(given_value)
    assert (result, type(result)) == (value, type(value))
    if isinstance(value, list):
        assert [type(item) for item in result] == [type(item) for item in value]


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (text("a: b"), "means a dict in YAML, which no parameter can be; if it is meant as text, wrap it: 'p': Param"),
        (text("<robot>: ["), "is no YAML; if it is meant as text, wrap it"),
        (text("null"), "means nothing in YAML"),
        (text("[1, 2.0]"), "is a list of several types"),
        (text("[]"), "empty list"),
        (text("[[1], [2]]"), "list of list"),
        (text("2026-01-01"), "a date"),
        ([[text("true")], [text("2.0")]], "list of bool, float"),
        ([1, [text("a")]], "list of int, str"),
        ([text("1"), 2], "list of"),
        (ParameterValue(text("x"), value_type=int), "is no int, which value_type asks for"),
        (ParameterValue(text("1.5"), value_type=int), "is no int"),
        (ParameterValue(text("1"), value_type=bool), "is no bool"),
        (ParameterValue(text("1"), value_type=list[int]), "is no list[int]"),
        (ParameterValue(text("1"), value_type=dict), "is no type of parameters"),
    ],
)
def test_what_no_parameter_can_be(value, words):
    with pytest.raises(TypeError) as error:
        evaluated(value)
    assert words in str(error.value)


@pytest.mark.parametrize(
    ("value", "value_type", "words"),
    [
        ("3", int, "the value '3' of ParameterValue is no int, which value_type asks for; only substitutions are"),
        ("true", bool, "'true' of ParameterValue is no bool"),
        (3, float, "3 of ParameterValue is no float"),
        (3, str, "3 of ParameterValue is no str"),
        (["1", "2"], list[int], "['1', '2'] of ParameterValue is no list[int]"),
        ("[1]", list[int], "'[1]' of ParameterValue is no list[int]"),
        ([1], int, "[1] of ParameterValue is no int"),
        (1, dict, "value_type=<class 'dict'> is no type of parameters"),
    ],
)
def test_a_plain_value_must_have_the_type_it_is_given_with(value, value_type, words):
    with pytest.raises(TypeError) as error:
        ParameterValue(value, value_type=value_type)
    assert words in str(error.value)


def test_configurations_are_typed_by_their_text():
    assert evaluated(LaunchConfiguration("x"), x="true") is True
    assert evaluated(LaunchConfiguration("x"), x="3") == 3
    assert Parameter("a", LaunchConfiguration("x")).name[0].perform(LaunchContext()) == "a"


SCALAR = st.one_of(
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    st.floats(),
    st.text(st.characters(blacklist_categories=["Cs"], blacklist_characters="\0")),
)
LETTERS = st.text("ab1 :'\"\n[]{}#-&*!|>%@`", max_size=5)
ONE_KIND = st.one_of(
    *[
        st.lists(kind, min_size=1, max_size=4)
        for kind in (st.booleans(), st.integers(-(2**63), 2**63 - 1), st.floats(), LETTERS)
    ]
)


def same(one, other):
    if isinstance(one, list):
        return isinstance(other, list) and len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, float) and math.isnan(one):
        return isinstance(other, float) and math.isnan(other)
    return type(one) is type(other) and one == other


@given(st.one_of(SCALAR, ONE_KIND))
def test_values_keep_their_type_on_the_way_through_files_and_arguments(value):
    written = evaluated(value)
    assert same(written, value)
    assert same(yaml.safe_load(as_argument(written)), value)
    assert same(yaml.safe_load(as_file("/**", {"p": written}))["/**"]["ros__parameters"]["p"], value)


@given(
    st.recursive(
        st.dictionaries(st.text("abc", min_size=1, max_size=2), st.integers(), max_size=3),
        lambda inner: st.dictionaries(st.text("abc", min_size=1, max_size=2), inner, max_size=3),
        max_leaves=6,
    )
)
def test_nested_names_are_joined_with_dots(nested):
    def leaves(tree, prefix):
        for name, value in tree.items():
            if isinstance(value, dict):
                yield from leaves(value, f"{prefix}{name}.")
            else:
                yield f"{prefix}{name}", value

    assert flattened(LaunchContext(), nested) == dict(leaves(nested, ""))


# A real node: one process with all values, in a file and as arguments.
NODE = """\
import json, sys
import rclpy
from rclpy.node import Node
rclpy.init(args=sys.argv)
node = Node("n", automatically_declare_parameters_from_overrides=True)
values = {}
for name, parameter in node.get_parameters_by_prefix("p").items():
    value = parameter.value
    values[name] = [parameter.type_.name, value if isinstance(value, (str, bool, int, float)) else list(value)]
print(json.dumps(values))
node.destroy_node()
rclpy.shutdown()
"""
VALUES = {
    "true": True,
    "whole": -(2**40),
    "fraction": 1e-06,
    "large": 1e22,
    "infinite": math.inf,
    "text": "5",
    "word": "yes",
    "empty": "",
    "urdf": '<robot name="a: b">\n  <!-- # -->\n</robot>\n',
    "unicode": "grün",
    "quotes": "'a' \"b\" \\n",
    "bools": [True, False],
    "wholes": [1, 2],
    "fractions": [1.0, 2.5],
    "texts": ["1", "true", "a b"],
}
KINDS = {bool: "BOOL", int: "INTEGER", float: "DOUBLE", str: "STRING"}


@pytest.mark.parametrize("way", ["file", "arguments"])
def test_a_real_node_gets_the_same_types(tmp_path, way):
    if way == "file":
        (tmp_path / "p.yaml").write_text(as_file("/n", {f"p.{name}": value for name, value in VALUES.items()}))
        words = ["--params-file", str(tmp_path / "p.yaml")]
    else:
        words = [w for name, value in VALUES.items() for w in ("-p", f"p.{name}:={as_argument(value)}")]
    done = warm_process.run(
        [sys.executable, "-c", NODE, "--ros-args", *words],
        env={**os.environ, "ROS_LOG_DIR": str(tmp_path), "ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    expected = {
        name: [KINDS[type(v[0])] + "_ARRAY", v] if isinstance(v, list) else [KINDS[type(v)], v]
        for name, v in VALUES.items()
    }
    assert json.loads(done.stdout) == expected
    assert array("d", expected["fractions"][1])


def test_the_error_is_a_type_error_and_a_sentence():
    assert issubclass(ParameterTypeError, TypeError)
