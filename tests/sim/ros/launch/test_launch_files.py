"""Launch files: loading, arguments, includes, and the messages about mistakes."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.sim.ros.launch import LaunchContext, LaunchDescription, LaunchIntrospector
from gz_course.sim.ros.launch.actions import (
    DeclareLaunchArgument,
    GroupAction,
    IncludeLaunchDescription,
    LogInfo,
    OpaqueFunction,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
)
from gz_course.sim.ros.launch.conditions import IfCondition
from gz_course.sim.ros.launch.errors import InvalidArgumentError, MissingArgumentError, sentence
from gz_course.sim.ros.launch.launch_description_sources import (
    AnyLaunchDescriptionSource,
    PythonLaunchDescriptionSource,
    get_launch_description_from_python_launch_file,
)
from gz_course.sim.ros.launch.substitutions import (
    LaunchConfiguration,
    TextSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)

HEAD = """\
import os
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import *
from launch.launch_description_sources import *
from launch.substitutions import *


def generate_launch_description():
"""


@pytest.fixture
def write(tmp_path):
    """Write a launch file with these entities or this text."""

    def write(name, entities=None, text=None):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(HEAD + f"    return LaunchDescription([{entities}])\n" if text is None else text)
        return path

    return write


def said(result):
    return [line.removeprefix("[INFO] [launch.user]: ") for line in result.lines if "[launch.user]" in line]


def include(path, **arguments):
    return IncludeLaunchDescription(PythonLaunchDescriptionSource(str(path)), launch_arguments=arguments.items())


def test_an_included_file_is_visited_with_its_arguments(run, write):
    path = write("a.launch.py", 'DeclareLaunchArgument("x"), LogInfo(msg=["x is ", LaunchConfiguration("x")])')
    result = run(include(path, x=["a", LaunchConfiguration("y")]), arguments={"y": "b"})
    assert said(result) == ["x is ab"]
    assert not (path.parent / "__pycache__").exists()


def test_arguments_as_pairs_or_a_dict_or_a_path_alone(run, write):
    path = write("a.launch.py", 'LogInfo(msg=LaunchConfiguration("x"))')
    result = run(
        IncludeLaunchDescription(str(path), launch_arguments={"x": "1"}),
        IncludeLaunchDescription(
            AnyLaunchDescriptionSource([str(path.parent), "/a.launch.py"]), launch_arguments=[("x", "2")]
        ),
        IncludeLaunchDescription(LaunchDescription([LogInfo(msg="made")])),
    )
    assert said(result) == ["1", "2", "made"]
    with pytest.raises(TypeError, match="pairs of name and value"):
        IncludeLaunchDescription(str(path), launch_arguments=["x"])
    with pytest.raises(TypeError, match="PythonLaunchDescriptionSource"):
        IncludeLaunchDescription(3)


def test_an_argument_without_a_value_is_refused_only_when_the_include_is_visited(run, write):
    path = write("a.launch.py", 'LogInfo(msg="visited")')
    options = {"launch_arguments": {"x": None}.items()}
    result = run(IncludeLaunchDescription(str(path), condition=IfCondition("false"), **options), LogInfo(msg="on"))
    assert (result.code, said(result)) == (0, ["on"])
    result = run(IncludeLaunchDescription(str(path), **options))
    assert result.code == 1 and "the launch argument 'x' has the value None" in result.text


def test_includes_are_looked_into_when_their_path_needs_no_launch(run, write, tmp_path, monkeypatch):
    """Their substitutions are performed; ThisLaunchFileDir is the folder of the including file."""
    monkeypatch.setenv("FOLDER", str(tmp_path))
    write("inner/deep.launch.py", 'DeclareLaunchArgument("deep", default_value="1")')
    write("inner/b.launch.py", "IncludeLaunchDescription([ThisLaunchFileDir(), '/deep.launch.py'])")
    path = write(
        "a.launch.py",
        'DeclareLaunchArgument("x", default_value="1"),'
        'IncludeLaunchDescription(PathJoinSubstitution([EnvironmentVariable("FOLDER"), "inner", "b.launch.py"])),'
        'IncludeLaunchDescription([ThisLaunchFileDir(), "/a.launch.py"], condition=IfCondition("false")),'
        'IncludeLaunchDescription([LaunchConfiguration("x"), "/none.launch.py"], condition=IfCondition("false")),',
    )
    description = get_launch_description_from_python_launch_file(str(path))
    assert [each.name for each in description.get_launch_arguments()] == ["x", "deep"]
    (tmp_path / "other").mkdir()
    write("other/inner/b.launch.py", 'LogInfo(msg="of the other folder")')
    look = OpaqueFunction(function=lambda context: description.get_launch_arguments() and None)
    result = run(look, SetEnvironmentVariable("FOLDER", str(tmp_path / "other")), description)
    assert said(result) == ["of the other folder"], "what was looked into is not what is launched"


def test_an_include_shares_the_scope_unless_it_is_grouped(run, write):
    path = write("a.launch.py", 'SetLaunchConfiguration("x", "2")')
    show = [LogInfo(msg=LaunchConfiguration("x"))]
    assert said(run(include(path), *show, arguments={"x": "1"})) == ["2"]
    assert said(run(GroupAction([include(path)]), *show, arguments={"x": "1"})) == ["1"]


def test_a_file_knows_where_it_is(run, write, tmp_path):
    inner = write("inner/b.launch.py", "LogInfo(msg=ThisLaunchFileDir())")
    outer = write(
        "a.launch.py",
        f"LogInfo(msg=ThisLaunchFile()), IncludeLaunchDescription({str(inner)!r}), LogInfo(msg=ThisLaunchFileDir())",
    )
    assert said(run(include(outer))) == [str(outer), str(tmp_path / "inner"), str(tmp_path)]
    assert run(LogInfo(msg=ThisLaunchFile())).code == 1
    assert run(LogInfo(msg=ThisLaunchFileDir())).code == 1


def test_a_relative_path_starts_in_the_current_folder(run, write, tmp_path, monkeypatch):
    write("a.launch.py", "LogInfo(msg=ThisLaunchFileDir())")
    monkeypatch.chdir(tmp_path)
    assert said(run(include("a.launch.py"))) == [str(tmp_path)]


# Arguments


def test_an_argument_keeps_what_is_given_and_else_has_its_default(run):
    x = DeclareLaunchArgument("x", default_value=[LaunchConfiguration("y"), "!"])
    assert said(run(x, LogInfo(msg=LaunchConfiguration("x")), arguments={"y": "1"})) == ["1!"]
    x = DeclareLaunchArgument("x", default_value="2")
    assert said(run(x, LogInfo(msg=LaunchConfiguration("x")), arguments={"x": "1"})) == ["1"]


def test_an_argument_that_must_be_given(run):
    result = run(DeclareLaunchArgument("x", description="how many"))
    assert result.code == 1
    assert 'Required launch argument "x" was not provided. (how many) Give it as x:=<value>.' in result.lines[-1]


def test_choices(run):
    colour = {"choices": ["red", "blue"]}
    assert run(DeclareLaunchArgument("c", **colour), arguments={"c": "red"}).code == 0
    result = run(DeclareLaunchArgument("c", **colour), arguments={"c": "rad"})
    text = "Argument \"c\" provided value \"rad\" is not valid. Valid options are: ['red', 'blue']"
    assert result.lines[0] == f"[ERROR] [launch]: {text}"
    assert result.lines[1].endswith(f"{text}; did you mean 'red'?")
    assert result.code == 1
    with pytest.raises(InvalidArgumentError):
        DeclareLaunchArgument("c", default_value="green", **colour)
    assert DeclareLaunchArgument("c", **colour).description == "One of: ['red', 'blue']"
    assert DeclareLaunchArgument("c", description="Colour.", **colour).description.startswith("Colour. Valid choices")
    assert DeclareLaunchArgument("c").description == "no description given"


def test_an_included_file_lacks_a_required_argument(run, write):
    path = write("a.launch.py", 'DeclareLaunchArgument("x", description="how many")')
    result = run(include(path, y="1", z="2"))
    assert result.code == 1
    assert (
        "Included launch description missing required argument 'x' (description: 'how many'), given: [y, z]"
        in result.lines[-1]
    )
    assert run(include(path), arguments={"x": "1"}).code == 0, "the scope has it"
    path = write("b.launch.py", 'DeclareLaunchArgument("x", condition=IfCondition("false"))')
    assert run(include(path)).code == 0


def test_a_misspelt_argument_of_an_include_is_told(run, write):
    path = write("a.launch.py", 'DeclareLaunchArgument("world", default_value="")')
    result = run(include(path, wrold="a", worlds="b"))
    assert result.code == 0
    assert result.lines == [
        f"[WARNING] [launch]: '{name}' is not an argument of {path} and has no effect there; did you mean 'world'?"
        for name in ("wrold", "worlds")
    ]


@pytest.mark.parametrize(
    "entities",
    [
        'LogInfo(msg=LaunchConfiguration("x", default=""))',
        "OpaqueFunction(function=lambda context: None)",
        "IncludeLaunchDescription([ThisLaunchFileDir(), '/empty.launch.py'])",
    ],
)
def test_what_may_use_an_argument_is_not_told(run, write, entities):
    write("empty.launch.py", "")
    result = run(include(write("a.launch.py", entities), x="1"))
    assert "WARNING" not in result.text


def test_arguments_are_found_in_includes_and_conditions(write):
    inner = write("inner.launch.py", 'DeclareLaunchArgument("a"), DeclareLaunchArgument("b", default_value="1")')
    unreadable = write("broken.launch.py", text="def")
    description = LaunchDescription(
        [
            include(inner),
            DeclareLaunchArgument("b", default_value="2"),
            GroupAction([DeclareLaunchArgument("c")], condition=IfCondition("true")),
            include(unreadable),
        ]
    )
    found = {argument.name: argument._conditionally_included for argument in description.get_launch_arguments()}
    assert found == {"a": False, "b": False, "c": True}


NAME = st.text("abcdefghijklmnopqrstuvwxyz_", min_size=1)
TEXT = st.text(st.characters(blacklist_categories=["Cs"]))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=25, deadline=None)
@given(st.dictionaries(NAME, TEXT, max_size=4), st.dictionaries(NAME, TEXT, max_size=4))
def test_arguments_arrive_as_they_were_given(given_values, defaults):
    context = LaunchContext()
    for name, value in given_values.items():
        SetLaunchConfiguration(name, value).visit(context)
    for name, value in defaults.items():
        DeclareLaunchArgument(name, default_value=TextSubstitution(text=value)).visit(context)
    assert context.launch_configurations == {**defaults, **given_values}


# Mistakes


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (HEAD + "    return LaunchDescription([\n", "{}:10: SyntaxError: '[' was never closed"),
        ("x = 1\n  y = 2\n", "{}:2: IndentationError: unexpected indent"),
        ("import no_such_module\n", "{}:1: ModuleNotFoundError: No module named 'no_such_module'"),
        (HEAD + "    return LaunchDescription([robot])\n", "{}:10: NameError: name 'robot' is not defined"),
        ("def helper():\n    1 / 0\nhelper()\n", "{}:2: ZeroDivisionError: division by zero"),
        ("", "'{}' does not contain the required function 'generate_launch_description()'"),
        ("def generate_launch_descripton():\n    pass\n", "its function 'generate_launch_descripton' has another name"),
        (
            HEAD + "    LaunchDescription([])\n",
            "returned None of type NoneType, not a LaunchDescription; its `return` is missing",
        ),
        (HEAD + "    return []\n", "returned [] of type list, not a LaunchDescription"),
        (
            HEAD + "    return [LogInfo(msg='a'), LogInfo(msg='b')]\n",
            "returned a list, not a LaunchDescription; write return LaunchDescription([...])",
        ),
        (HEAD + "    return LaunchDescription([LogInfo(msg=3)])\n", "{}:10: 3 is of type int; text, a substitution"),
        (HEAD + "    return LaunchDescription(LogInfo(msg=''))\n", "{}:10: TypeError: LaunchDescription wants a list"),
        ("x = '\0'\n", "{}"),
    ],
)
def test_mistakes_are_told_with_file_and_line(run, write, text, words):
    path = write("bad.launch.py", text=text)
    with pytest.raises(Exception) as error:
        get_launch_description_from_python_launch_file(str(path))
    assert words.format(path) in sentence(error.value)
    result = run(include(path))
    assert result.code == 1
    assert words.format(path) in result.lines[-1]
    assert len(result.lines) == 1


def test_a_file_that_is_not_there(run, write, tmp_path, monkeypatch):
    write("robot.launch.py", "")
    result = run(include(tmp_path / "robt.launch.py"))
    assert f"there is no launch file '{tmp_path}/robt.launch.py'; did you mean 'robot.launch.py'?" in result.lines[-1]
    (tmp_path / "prefix/share/my_robot/launch").mkdir(parents=True)
    (tmp_path / "prefix/share/my_robot/launch/drive.launch.py").touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    result = run(include("drive.launch.py"))
    assert result.code == 1
    assert (
        "the package my_robot has one of that name: write PathJoinSubstitution([FindPackageShare"
        '("my_robot"), "launch", "drive.launch.py"])' in result.lines[-1]
    )


def test_files_that_include_each_other_without_end(run, write, tmp_path):
    a = write("a.launch.py", f"IncludeLaunchDescription({str(tmp_path / 'b.launch.py')!r})")
    write("b.launch.py", f"IncludeLaunchDescription({str(a)!r}, launch_arguments={{'x': '1'}})")
    result = run(include(a))
    assert result.code == 1
    assert "the launch files include each other without end" in result.lines[-1]
    assert "b.launch.py ->" in result.lines[-1]
    growing = write(
        "c.launch.py",
        "SetLaunchConfiguration('x', [LaunchConfiguration('x', default=''), 'x']), "
        "IncludeLaunchDescription(ThisLaunchFile())",
    )
    assert "without end" in run(include(growing)).lines[-1]


def test_a_file_may_include_itself_with_an_end(run, write, tmp_path):
    countdown = (
        'LogInfo(msg=LaunchConfiguration("n")), IncludeLaunchDescription(ThisLaunchFile(), '
        'launch_arguments={"n": PythonExpression([LaunchConfiguration("n"), "-1"])}, '
        'condition=IfCondition(PythonExpression([LaunchConfiguration("n"), " > 1"])))'
    )
    assert said(run(include(write("a.launch.py", countdown), n="3"))) == ["3", "2", "1"]


def test_a_launch_description_is_shown_as_a_tree(write):
    inner = write("a.launch.py", 'DeclareLaunchArgument("x")')
    group = GroupAction([LogInfo(msg="in")], condition=IfCondition("true"))
    description = LaunchDescription([LogInfo(msg=["a", LaunchConfiguration("x")]), group, include(inner)])
    first, *rest = LaunchIntrospector().format_launch_description(description).splitlines()
    assert first.startswith("<launch.launch_description.LaunchDescription object at 0x")
    assert rest[0] == "├── LogInfo('a' + LaunchConfig('x'))"
    assert rest[-3] == f"└── IncludeLaunchDescription('{inner}')"
    assert rest[-1] == "        └── DeclareLaunchArgument('x')"
    assert any("LogInfo('in')" in line for line in rest)


def test_required_arguments_have_a_type_of_their_own():
    with pytest.raises(MissingArgumentError):
        DeclareLaunchArgument("x").execute(LaunchContext())
