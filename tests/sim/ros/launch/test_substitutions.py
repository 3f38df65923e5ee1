"""Substitutions: their texts, and the errors if they have none."""

import math
import os
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.ros.launch import LaunchContext, Substitution
from gz_course.sim.ros.launch.frontend import parse_substitution
from gz_course.sim.ros.launch.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnonName,
    AnySubstitution,
    Command,
    EnvironmentVariable,
    EqualsSubstitution,
    FileContent,
    FindExecutable,
    IfElseSubstitution,
    LaunchConfiguration,
    LaunchLogDir,
    LocalSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    PathJoinSubstitution,
    PathSubstitution,
    PythonExpression,
    SubstitutionFailure,
    TextSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

TEXT = st.text(st.characters(blacklist_categories=["Cs"], blacklist_characters="\0"))


@given(st.lists(TEXT, max_size=5))
def test_some_substitutions_are_concatenated(parts):
    mixed = [TextSubstitution(text=part) if index % 2 else part for index, part in enumerate(parts)]
    assert perform_substitutions(LaunchContext(), normalize_to_list_of_substitutions(mixed)) == "".join(parts)


@pytest.mark.parametrize("wrong", [3, 2.5, True, None, [1], ["a", None], {"a": 1}, b"a"])
def test_what_is_no_text_is_a_type_error(wrong):
    with pytest.raises(TypeError, match="is of type"):
        normalize_to_list_of_substitutions(wrong)


def test_a_launch_configuration_has_its_value_or_its_default(performed):
    assert performed(LaunchConfiguration("x"), x="1") == "1"
    assert performed(LaunchConfiguration("x", default=5)) == "5"
    assert performed(LaunchConfiguration("x", default=["a", TextSubstitution(text="b"), 3])) == "ab3"
    assert performed(LaunchConfiguration(["x", "_y"]), x_y="z") == "z"
    with pytest.raises(SubstitutionFailure, match=r"launch configuration 'wrld' does not exist; did you mean 'world'"):
        performed(LaunchConfiguration("wrld"), world="1")


def test_environment_variables(performed, monkeypatch):
    monkeypatch.setenv("COLOUR", "blue")
    monkeypatch.delenv("SHAPE", raising=False)
    assert performed(EnvironmentVariable("COLOUR")) == "blue"
    assert performed(EnvironmentVariable("SHAPE", default_value="")) == ""
    with pytest.raises(SubstitutionFailure, match="environment variable 'SHAPE' does not exist"):
        performed(EnvironmentVariable("SHAPE"))


@given(st.lists(TEXT, max_size=5))
def test_paths_are_joined_as_os_path_joins_them(parts):
    expected = os.path.join("", *parts)  # noqa: PTH118
    assert PathJoinSubstitution(parts).perform(LaunchContext()) == expected
    assert PathJoinSubstitution([[part] for part in parts]).perform(LaunchContext()) == expected


def test_a_list_is_one_component_of_a_path_and_a_slash_adds_one(performed):
    path = PathJoinSubstitution(["a", ["b", LaunchConfiguration("x")]])
    assert performed(path / "c", x="1") == "a/b1/c"
    assert performed(PathSubstitution("/a") / "b" / LaunchConfiguration("x"), x="c") == "/a/b/c"


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("1 + 1", "2"),
        ("'a' == 'a'", "True"),
        ("sqrt(9)", "3.0"),
        ("math.pi > 3", "True"),
        ("[x for x in 'ab']", "['a', 'b']"),
    ],
)
def test_python_expressions(performed, expression, value):
    assert performed(PythonExpression(expression)) == value


def test_python_expressions_use_modules_that_are_named(performed):
    assert performed(PythonExpression(["os.path.basename('", "/a/b", "')"], python_modules=["os.path"])) == "b"
    with pytest.raises(SubstitutionFailure, match="cannot import 'no_such_module'"):
        performed(PythonExpression("1", python_modules=["no_such_module"]))


def test_an_expression_without_quotes_is_explained(performed):
    with pytest.raises(SubstitutionFailure, match=r"'fast == 1'.*NameError.*quotes inside the expression"):
        performed(PythonExpression([LaunchConfiguration("mode"), " == 1"]), mode="fast")


@pytest.mark.parametrize("text", ["true", "True", " TRUE ", "1"])
def test_what_is_true(performed, text):
    assert performed(NotSubstitution(text)) == "false"


@pytest.mark.parametrize("text", ["false", "False", " FALSE ", "0"])
def test_what_is_false(performed, text):
    assert performed(NotSubstitution(text)) == "true"


@pytest.mark.parametrize("text", ["yes", "", "2", "on"])
def test_what_is_neither(performed, text):
    with pytest.raises(SubstitutionFailure, match="neither true nor false"):
        performed(AndSubstitution("true", text))


@given(st.booleans(), st.booleans(), st.booleans())
def test_boolean_substitutions_are_those_of_logic(a, b, c):
    def is_true(substitution):
        text = substitution.perform(LaunchContext())
        assert text in ("true", "false")
        return text == "true"

    assert is_true(AndSubstitution(str(a), str(b))) is (a and b)
    assert is_true(OrSubstitution(str(a), str(b))) is (a or b)
    assert is_true(AllSubstitution(str(a), str(b), str(c))) is (a and b and c)
    assert is_true(AnySubstitution(str(a), str(b), str(c))) is (a or b or c)
    assert is_true(EqualsSubstitution(a, str(b))) is (a == b)
    assert is_true(NotEqualsSubstitution(a, b)) is (a != b)
    assert IfElseSubstitution(a, "x", "y").perform(LaunchContext()) == ("x" if a else "y")


@given(st.floats(allow_nan=False), st.floats(allow_nan=False))
def test_numbers_are_equal_when_they_are_close(a, b):
    expected = str(math.isclose(a, b)).lower()
    texts = {str(a), str(b)}
    if not texts <= {"0", "1"}:
        assert EqualsSubstitution(repr(a), repr(b)).perform(LaunchContext()) == expected


@given(TEXT)
def test_texts_are_equal_to_themselves(text):
    assert EqualsSubstitution(text, text).perform(LaunchContext()) == "true" or math.isnan(float(text))


def test_commands(performed):
    assert performed(Command(["printf '%s\\n' 'a b' ", LaunchConfiguration("x")]), x="c") == "a b\nc\n"
    script = "sh -c 'echo out; echo err >&2'"
    assert performed(Command(script, on_stderr="ignore")) == "out\n"
    assert performed(Command(script, on_stderr="capture")) == "out\nerr\n"
    mixed = "sh -c 'echo err >&2; echo out; echo more >&2'"
    assert performed(Command(mixed, on_stderr="capture")) == "err\nout\nmore\n"


def test_a_command_may_warn_of_stderr(performed, capsys):
    assert performed(Command("sh -c 'echo err >&2'", on_stderr="warn")) == ""
    assert "[WARNING] [launch.substitutions.command]" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("command", "options", "words"),
    [
        ("sh -c 'echo bad >&2; exit 3'", {}, "failed with exit code 3: bad"),
        ("sh -c 'kill -9 $$'", {}, "failed with signal SIGKILL"),
        ("python3 -S -c 'raise OSError(5)'", {}, "failed with exit code 1: OSError: 5"),
        ("sh -c 'echo bad >&2'", {}, "wrote to stderr, which on_stderr='warn' would allow: bad"),
        ("pyton3 -c 1", {}, "there is no program 'pyton3' for Command to run; did you mean 'python3"),
        ("echo 'a", {}, "cannot be split into words"),
        ("", {}, "empty"),
        ("true", {"on_stderr": "explode"}, "it can be fail, ignore, warn, capture"),
    ],
)
def test_commands_that_fail(performed, command, options, words):
    with pytest.raises(SubstitutionFailure) as error:
        performed(Command(command, **options))
    assert words in str(error.value)


def test_executables_on_the_path(performed, monkeypatch):
    monkeypatch.setenv("PATH", str(Path(sys.executable).parent))
    assert Path(performed(FindExecutable(name="python3"))).name == "python3"
    with pytest.raises(SubstitutionFailure, match="'pyhton3' not found on the PATH; did you mean 'python3"):
        performed(FindExecutable(name="pyhton3"))


def test_the_content_of_a_file(performed, tmp_path):
    (tmp_path / "a.urdf").write_text("<robot/>\n")
    assert performed(FileContent(tmp_path / "a.urdf")) == "<robot/>\n"
    with pytest.raises(SubstitutionFailure, match="cannot be read: No such file"):
        performed(FileContent([str(tmp_path), "/b"]))


def test_an_anonymous_name_is_fit_for_a_node_and_stays_the_same():
    context = LaunchContext()
    names = [AnonName(name).perform(context) for name in ("a", "a", "b")]
    assert names[0] == names[1] != names[2]
    assert all(name.isidentifier() for name in names)


def test_values_of_the_moment_exist_only_then(performed):
    for substitution in (ThisLaunchFileDir(), LocalSubstitution("event.returncode")):
        with pytest.raises(SubstitutionFailure):
            performed(substitution)
    context = LaunchContext()
    context.extend_locals({"event": type("Event", (), {"returncode": 3})()})
    assert LocalSubstitution("event.returncode").perform(context) == "3"
    with pytest.raises(SubstitutionFailure, match="did you mean 'returncode'"):
        LocalSubstitution("event.retrncode").perform(context)


def test_a_substitution_of_the_user_that_gives_no_text_is_named(performed):
    class Number(Substitution):
        def perform(self, context):
            return 3

    with pytest.raises(Exception, match=r"Number.perform\(\) returned 3 of type int"):
        performed(Number())


@given(TEXT.filter(lambda text: "$(" not in text and "\\" not in text))
def test_text_without_substitutions_is_read_as_it_stands(text):
    assert perform_substitutions(LaunchContext(), parse_substitution(text)) == text


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("a $(var x) b", "a 1 b"),
        ("$(var y)", None),
        ("$(var y 'a b')", "a b"),
        ("$(env NO_SUCH_VARIABLE $(var x))", "1"),
        ("$(eval '$(var x) + 1')", "2"),
        ("\\$(var x)", "$(var x)"),
        ("$(var", None),
        ("$(vra x)", None),
        ("$(var)", None),
        ("$()", None),
    ],
)
def test_substitutions_in_text(text, value):
    context = LaunchContext()
    context.launch_configurations["x"] = "1"
    if value is None:
        with pytest.raises(SubstitutionFailure):
            perform_substitutions(context, parse_substitution(text))
    else:
        assert perform_substitutions(context, parse_substitution(text)) == value


def test_a_slash_adds_components_to_the_paths_of_the_launch():
    context = LaunchContext()
    context.extend_locals({"current_launch_file_directory": "/here", "current_launch_file_path": "/here/a.launch.py"})
    name = TextSubstitution(text="bridge.yaml")
    assert (ThisLaunchFileDir() / "config" / name).perform(context) == "/here/config/bridge.yaml"
    assert (ThisLaunchFile() / "x").perform(context) == "/here/a.launch.py/x"
    assert (LaunchLogDir() / "x").perform(context) == LaunchLogDir().perform(context) + "/x"
