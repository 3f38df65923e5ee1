"""`ros2 param` against a node with parameters of every kind."""

import sys

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.parameter import (
    flat,
    kind_word,
    nested,
    parameter_value,
    python_value,
    type_word,
    value_from_yaml,
)

NODE = "/robot/driver"
VALUES = {
    "speed": ("Double value is: 1.5", "double"),
    "count": ("Integer value is: 3", "integer"),
    "frame.id": ("String value is: base", "string"),
    "armed": ("Boolean value is: True", "boolean"),
    "bytes": ("Byte values are: [97, 1]", "byte array"),
    "flags": ("Boolean values are: [True, False]", "boolean array"),
    "ports": ("Integer values are: [1, 2]", "integer array"),
    "gains": ("Double values are: [1.0, 0.5]", "double array"),
    "joints": ("String values are: ['left', 'right']", "string array"),
}
ASKED = {
    **{name: ["get", NODE, name] for name in VALUES},
    "list": ["list"],
    "names": ["list", NODE, "--param-type"],
    "some": ["list", NODE, "--param-prefixes", "frame"],
    "filtered": ["list", NODE, "--filter", "^f"],
    "bad filter": ["list", NODE, "--filter", "("],
    "hide type": ["get", NODE, "speed", "--hide-type"],
    "unset": ["get", NODE, "unset"],
    "no parameter": ["get", NODE, "sped"],
    "no node": ["get", "/robot/drivr", "speed", "--timeout", "1"],
    "no services": ["get", "/robot/idle", "speed"],
    "describe": ["describe", NODE, "speed", "serial", "frame.id", "count"],
    "describe none": ["describe", NODE, "sped"],
    "dump": ["dump", NODE],
    "wrong type": ["set", NODE, "speed", "2"],
    "out of range": ["set", "--strict", NODE, "speed", "9.5"],
    "read only": ["set", NODE, "serial", "8"],
    "not yaml": ["set", NODE, "speed", "[1,"],
    "mixed": ["set", NODE, "ports", "[1, a]"],
    "delete fixed": ["delete", NODE, "serial"],
    "delete none": ["delete", NODE, "fre"],
}


@pytest.fixture(scope="module")
def answers(robot, run_together):
    return dict(zip(ASKED, run_together(*(["param", *words] for words in ASKED.values())), strict=True))


@pytest.mark.parametrize("name", VALUES)
def test_get_names_the_kind(answers, name):
    assert answers[name] == (0, f"{VALUES[name][0]}\n", "")


def test_list(answers):
    code, text, errors = answers["list"]
    names = yaml.safe_load(text.replace("\n  ", "\n  - "))[NODE]
    assert (code, errors) == (0, "")
    assert names == sorted(names)
    assert {*VALUES, "serial", "use_sim_time"} <= set(names)
    lines = answers["names"][1].splitlines()
    assert {f"  {name} (type: {kind})" for name, (_, kind) in VALUES.items()} <= set(lines)
    assert answers["some"][1] == "  frame.id\n  frame.parent\n"
    assert answers["filtered"][1] == "  flags\n  frame.id\n  frame.parent\n  free\n"
    assert answers["hide type"] == (0, "1.5\n", "")


def test_describe_tells_the_limits(answers):
    assert answers["describe"] == (
        0,
        "Parameter name: speed\n  Type: double\n  Description: how fast\n  Constraints:\n"
        "    Min value: 0.0\n    Max value: 3.0\n    Step: 0.5\n"
        "Parameter name: serial\n  Type: integer\n  Constraints:\n    Read only: true\n"
        "Parameter name: frame.id\n  Type: string\n  Constraints:\n"
        "    Additional constraints: a frame of the robot\n"
        "Parameter name: count\n  Type: integer\n  Constraints:\n    Min value: 0\n    Max value: 9\n",
        "",
    )


def test_dump_is_a_parameter_file(answers):
    code, text, errors = answers["dump"]
    assert (code, errors) == (0, "")
    assert text.endswith("\n\n")
    held = yaml.safe_load(text)[NODE]["ros__parameters"]
    assert held["frame"] == {"id": "base", "parent": "odom"}
    assert (held["speed"], held["gains"], held["bytes"]) == (1.5, [1.0, 0.5], [97, 1])
    assert "unset" not in held


@pytest.mark.parametrize(
    ("asked", "code", "sentence"),
    [
        ("bad filter", 1, "--filter '(' is not a regular expression: "),
        ("unset", 1, "Parameter not set\n"),
        ("no parameter", 1, "Parameter not set; did you mean 'speed'?\n"),
        ("no node", 1, "Node not found; did you mean '/robot/driver'?\n"),
        ("no services", 1, "The node /robot/idle has no parameter services\n"),
        ("describe none", 1, "Parameter not set; did you mean 'speed'?\n"),
        ("wrong type", 0, "Setting parameter failed: Wrong parameter type, expected 'Type.DOUBLE'"),
        ("out of range", 1, "Setting parameter failed: Parameter speed out of range"),
        ("read only", 0, "Setting parameter failed: Trying to set a read-only parameter: serial."),
        ("not yaml", 1, "The passed value is not YAML: line "),
        ("mixed", 1, "'[1, a]' cannot be a parameter: the items of a list must be of one kind\n"),
        ("delete fixed", 1, "Deleting parameter failed: "),
        ("delete none", 1, "Parameter not set; did you mean 'free'?\n"),
    ],
)
def test_what_is_wrong_is_one_sentence(answers, asked, code, sentence):
    found, text, errors = answers[asked]
    assert (found, text) == (code, "")
    assert errors.startswith(sentence)
    assert len(errors.splitlines()) == 1


@pytest.mark.parametrize("value", ["hello", "2.5", "[a, b]", "true"])
def test_set_changes_the_kind_of_a_dynamic_parameter(ros2, robot, answers, value):
    assert ros2("param", "set", NODE, "free", value) == (0, "Set parameter successful\n", "")
    assert robot.get_parameter("free").value == yaml.safe_load(value)


def test_an_empty_list_is_of_the_kind_the_parameter_has(ros2, robot, answers):
    assert ros2("param", "set", NODE, "gains", "[]") == (0, "Set parameter successful\n", "")
    assert list(robot.get_parameter("gains").value) == []


def test_delete(ros2, robot, answers):
    assert ros2("param", "delete", NODE, "gone") == (0, "Deleted parameter successfully\n", "")
    assert not robot.has_parameter("gone")


def test_what_was_dumped_can_be_loaded(ros2, robot, answers, tmp_path):
    (tmp_path / "robot.yaml").write_text(answers["dump"][1].replace("count: 3", "count: 4"))
    code, text, errors = ros2("param", "load", NODE, str(tmp_path / "robot.yaml"))
    assert code == 0
    assert {f"Set parameter {name} successful" for name in VALUES} <= set(text.splitlines())
    assert "Set parameter serial failed: " in errors
    assert robot.get_parameter("count").value == 4
    assert robot.get_parameter("bytes").value == [b"a", b"\x01"]


LOADED = {
    "wildcard": ("/**: {ros__parameters: {count: 5}}", 0, "Set parameter count successful\n", ""),
    "refused": ("/**: {ros__parameters: {count: 50}}", 1, "", "Set parameter count failed: "),
    "other": (
        "/robot/drivr: {ros__parameters: {}}",
        1,
        "",
        "Param file does not contain parameters for /robot/driver, ",
    ),
    "no key": ("/robot/driver: {count: 5}", 1, "", "there must be 'ros__parameters:'"),
    "not yaml": ("/robot/driver: [", 1, "", "is not YAML: line "),
    "no mapping": ("5", 1, "", "is no parameter file"),
    "mixed": ("/**: {ros__parameters: {ports: [1, a]}}", 1, "", "ports: [1, 'a']\" cannot be a parameter"),
}


def test_load_says_what_is_wrong_with_a_file(robot, answers, run_together, tmp_path):
    for name, (text, *_) in LOADED.items():
        (tmp_path / name).write_text(text)
    words = [["param", "load", "--strict", NODE, str(tmp_path / name)] for name in [*LOADED, "missing"]]
    *found, missing = run_together(*words)
    for (_, code, text, sentence), answer in zip(LOADED.values(), found, strict=True):
        assert answer[:2] == (code, text)
        assert sentence in answer[2]
    assert missing == (1, "", f"{tmp_path}/missing cannot be read: No such file or directory\n")


PLAIN = st.one_of(st.booleans(), st.integers(-(2**63), 2**63 - 1), st.floats(allow_nan=False), st.text(max_size=20))
LISTS = st.one_of(*(st.lists(kind, min_size=1, max_size=5) for kind in (st.booleans(), st.integers(-9, 9), st.text())))


@given(st.one_of(PLAIN, LISTS))
def test_a_value_comes_back_as_it_was(value):
    message = value_from_yaml(yaml.safe_dump(value))
    found = python_value(message)
    assert found == value
    assert kind_word(message).endswith("values are:" if isinstance(value, list) else "value is:")
    assert python_value(parameter_value(value, "")) == value


@given(st.text(max_size=30))
def test_any_text_is_a_value_or_one_sentence(text):
    try:
        assert type_word(value_from_yaml(text).type) != "not set"
    except CommandError as error:
        assert len(str(error).splitlines()) == 1


@pytest.mark.parametrize(
    ("text", "value"), [("1e-3", 0.001), ("1E3", 1000.0), ("'5'", "5"), ("", ""), ("null", "null"), ("2026-11-21",) * 2]
)
def test_what_yaml_would_guess_otherwise(text, value):
    assert python_value(value_from_yaml(text)) == value


NAMES = st.text("ab.", min_size=1, max_size=6).filter(lambda name: all(name.split(".")))


@given(st.dictionaries(NAMES, st.integers(), max_size=8))
def test_nested_and_flat_are_each_others_reverse(parameters):
    assert flat(nested(parameters)) == parameters


BUSY_NODE = """
import os, signal
import rclpy
from rclpy.node import Node

class Busy(Node):
    def get_parameter(self, name):
        if name == "speed":
            {act}
        return super().get_parameter(name)

rclpy.init()
node = Busy("busy")
node.declare_parameter("speed", 1.5)
print("up", flush=True)
rclpy.spin(node)
"""


@pytest.mark.parametrize(
    "act", ["os.kill(os.getpid(), signal.SIGKILL)", pytest.param("signal.pause()", marks=pytest.mark.proof)]
)
def test_a_node_that_ends_or_hangs_while_it_is_asked_is_told_in_time(start, act, ros_domain):
    node = start("-c", BUSY_NODE.format(act=act), command=(sys.executable,))
    node.wait_for("up")
    code, output, errors = start("param", "get", "/busy", "speed").wait()
    assert (code, output) == (1, "")
    assert errors == (
        "The service /busy/get_parameters has not answered within 5 s; the node /busy does not spin, is busy in a "
        "callback, or was killed: ros2 node list\n"
    )
