"""Launch files in XML and YAML: the same actions as in Python, and mistakes with their place."""

import pytest

from gz_course.sim.ros.launch import LaunchContext
from gz_course.sim.ros.launch.actions import IncludeLaunchDescription
from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.frontend import parse_substitution
from gz_course.sim.ros.launch.launch_description_sources import (
    AnyLaunchDescriptionSource,
    get_launch_description_from_any_launch_file,
)
from gz_course.sim.ros.launch.substitutions import SubstitutionFailure

XML = """\
<launch>
  <arg name="x" default="5" description="how many"><choice value="5"/><choice value="6"/></arg>
  <let name="y" value="$(var x)$(eval '1 + $(var x)')"/>
  <log message="y is $(var y) in $(dirname)"/>
  <group scoped="true">
    <let name="y" value="inside"/>
    <set_env name="FOO" value="$(var y)"/>
    <append_env name="FOO" value="more" separator="-"/>
    <log message="$(env FOO)"/>
    <unset_env name="FOO"/>
  </group>
  <log message="y is $(var y) and FOO $(env FOO unset)"/>
  <executable cmd="echo 'two words' $(var x)$(var x)x &quot;y z&quot;" output="screen" name="say">
    <env name="A" value="b"/>
  </executable>
  <log message="no" if="$(equals $(var x) 6)"/>
  <log message="yes" unless="false"/>
  <timer period="0.0"><log message="late"/></timer>
</launch>
"""
YAML = """\
launch:
  - arg: {name: x, default: '5', description: how many, choice: [{value: '5'}, {value: '6'}]}
  - let: {name: y, value: "$(var x)$(eval '1 + $(var x)')"}
  - log: {message: y is $(var y) in $(dirname)}
  - group:
      scoped: true
      children:
        - let: {name: y, value: inside}
        - set_env: {name: FOO, value: $(var y)}
        - append_env: {name: FOO, value: more, separator: '-'}
        - log: {message: $(env FOO)}
        - unset_env: {name: FOO}
  - log: {message: y is $(var y) and FOO $(env FOO unset)}
  - executable:
      cmd: echo 'two words' $(var x)$(var x)x "y z"
      output: screen
      name: say
      env: [{name: A, value: b}]
  - log: {message: 'no', if: $(equals $(var x) 6)}
  - log: {message: 'yes', unless: 'false'}
  - timer: {period: 0.0, children: [{log: {message: late}}]}
"""


@pytest.fixture
def write(tmp_path):
    def write(name, text):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def said(result):
    return [line.removeprefix("[INFO] [launch.user]: ") for line in result.lines if "[launch.user]" in line]


def include(path, **arguments):
    return IncludeLaunchDescription(AnyLaunchDescriptionSource(str(path)), launch_arguments=arguments.items())


@pytest.mark.parametrize(
    ("name", "text"),
    [("a.launch.xml", XML), ("a.launch.yaml", YAML), ("a.launch", XML), ("b.launch", f"# YAML\n---\n{YAML}")],
)
def test_a_file_does_what_it_says(run, write, tmp_path, name, text):
    path = write(name, text)
    result = run(include(path))
    assert said(result) == [f"y is 56 in {tmp_path}", "inside-more", "y is 56 and FOO unset", "yes", "late"]
    assert result.printed_by("say") == ["two words 55x y z"]
    (argument,) = get_launch_description_from_any_launch_file(str(path)).get_launch_arguments()
    assert (argument.name, argument.description) == ("x", "how many. Valid choices are: ['5', '6']")
    assert argument.default_value[0].describe() == "'5'"


def test_files_of_all_kinds_include_each_other(run, write):
    write("c.launch.yaml", "launch:\n- log: {message: 'yaml $(var v)'}\n- include: {file: $(dirname)/d.launch.py}\n")
    write(
        "d.launch.py",
        "from launch import LaunchDescription\nfrom launch.actions import LogInfo, IncludeLaunchDescription\n"
        "from launch.substitutions import ThisLaunchFileDir\n"
        "def generate_launch_description():\n    return LaunchDescription([LogInfo(msg='python'),\n"
        "        IncludeLaunchDescription([ThisLaunchFileDir(), '/e.launch.xml'])])\n",
    )
    write("e.launch.xml", '<launch><arg name="last" default=""/><log message="xml again"/></launch>')
    path = write(
        "b.launch.xml",
        '<launch><log message="xml"/><include file="$(dirname)/c.launch.yaml"><arg name="v" value="1"/></include>'
        "</launch>",
    )
    assert said(run(include(path))) == ["xml", "yaml 1", "python", "xml again"]
    arguments = get_launch_description_from_any_launch_file(str(path)).get_launch_arguments()
    assert [each.name for each in arguments] == ["last"]


MISTAKES = [
    ("<launch>\n  <nod pkg='a'/>\n</launch>", "2:3: there is no action <nod>; did you mean 'node'?"),
    ("<launch>\n  <param name='a'/>\n</launch>", "2:3: there is no action <param>; write set_parameter"),
    ("<launch>\n  <log mesage='a'/>\n</launch>", "2:3: <log> lacks the attribute 'message'; it has 'mesage'"),
    ("<launch>\n  <log message='a' iff='1'/></launch>", "2:20: <log> has no attribute 'iff'; did you mean 'if'?"),
    ("<launch>\n  <node exec='a' type='b'/></launch>", "2:18: <node> has no attribute 'type'; write exec"),
    ("<launch>\n  <log\n   message='$(vra x)'/></launch>", "3:4: 'message' of <log>: there is no substitution $(vra "),
    (
        "<launch><log message='$(arg x)'/></launch>",
        "1:14: 'message' of <log>: there is no substitution $(arg ...)",
    ),
    ("<launch><log message='$(var x'/></launch>", "1:14: 'message' of <log>: a ) is missing after '$(var x'"),
    ("<launch><log message='a' if='1' unless='1'/></launch>", "`if` and `unless` exclude each other"),
    ("<launch><group><log/></group></launch>", "1:16: <log> lacks the attribute 'message'"),
    ("<launch><timer period='soon'/></launch>", "1:9: period='soon' of TimerAction is no number"),
    ("<launch><executable cmd='a' respawn='maybe'/></launch>", "1:9: invalid condition expression: 'maybe'"),
    (
        "<launch><executable cmd='a' respawn_delay='$(var x)'/></launch>",
        "1:29: 'respawn_delay' of <executable> is '$(var x)', not a number with a point",
    ),
    ("<launch><executable cmd='a' sigterm_timeout='-1'/></launch>", "1:29: 'sigterm_timeout' of <executable>: "),
    ("<launch><append_env name='A' value='b' prepend='maybe'/></launch>", "prepend is the text 'maybe'; write true or"),
    ('<launch><executable cmd="echo \'a"/></launch>', "1:21: 'cmd' of <executable>: the command cannot be split"),
    ("<launch><executable cmd='a' on_exit='x'/></launch>", "on_exit is 'x'; it can be 'shutdown'"),
    (
        "<launch><executable cmd='a'><evn/></executable></launch>",
        "1:29: <executable> cannot hold <evn>; did you mean 'e",
    ),
    (
        "<launch><arg name='a' default='1'><choice value='2'/></arg></launch>",
        '1:9: <arg>: Argument "a" has',
    ),
    ("<lunch/>", "1:1: a launch file begins with `launch`, this one with <lunch>"),
    ("<launch>\n<log message='a'></launch>", "2:20: this is no XML: mismatched tag; <log> of line 2 is open"),
    ("", "this is no XML: no element found"),
    ("launch:\n  - nod: {pkg: a}\n", "2:5: there is no action 'nod'; did you mean 'node'?"),
    ("launch:\n  - log: {mesage: a}\n", "2:5: 'log' lacks the key 'message'; it has 'mesage'"),
    ("launch:\n  - log: {message: a, iff: 1}\n", "2:23: 'log' has no key 'iff'; did you mean 'if'?"),
    ("launch:\n  - log: {message: 1}\n", "2:11: 'message' of 'log' is 1, not text; write '1' with its quotes"),
    ("launch:\n  - log: a\n", "2:5: below 'log' stands 'a', not keys with values"),
    ("launch:\n  - log\n", "an item of 'launch' is one key, the name of an action, not 'log'"),
    (
        "launch:\n  - log:\n    message: a\n",
        "2:5: an item of 'launch' is one key, the name of an action, not",
    ),
    (
        "launch:\n  - timer: {period: 5, children: []}\n",
        "2:13: 'period' of 'timer' is 5, not a number with a point",
    ),
    ("launch:\n  - timer: {period: 5.0}\n", "2:5: 'timer' lacks the key 'children', a list of actions"),
    (
        "launch:\n  - executable: {cmd: a, respawn: true}\n",
        "2:26: 'respawn' of 'executable' is True, not text; write 'true' with its quotes",
    ),
    (
        "launch:\n  - executable: {cmd: a, respawn_delay: '2.0'}\n",
        "is '2.0', not a number with a point; write it without quotes and substitutions",
    ),
    ("launch:\n  - executable: {cmd: a, respawn_delay: 2}\n", "is 2, not a number with a point; write 2.0"),
    ("launch:\n  - executable: {cmd: a, name: }\n", "is nothing, not text; give it one, or leave the key out"),
    ("launch:\n  - append_env: {name: A, value: b, prepend: 'true'}\n", "prepend is the text 'true'; write true or"),
    ("launch: 3\n", "1:1: below 'launch' stands 3, not a list of actions"),
    ("lunch: []\n", "1:1: a launch file begins with `launch`, this one with 'lunch'"),
    ("launch: [\n", "this is no YAML: "),
    ("a: 1\nb: 2\n", "a launch file in YAML has one key, `launch:`, and below it a list; this has keys a, b"),
]


def test_mistakes_are_told_with_file_line_and_column(run, write):
    for number, (text, words) in enumerate(MISTAKES):
        name = f"{number}.launch.{'yaml' if text[:1].isalpha() else 'xml'}"
        path = write(name, text)
        result = run(include(path))
        (line,) = [each for each in result.lines if "Caught exception" in each]
        assert f": {path}:" in line and words in line, (text, line)
        assert (result.code, line.count(str(path))) == (1, 1)
        assert "Traceback" not in result.text


def test_a_failure_while_it_runs_has_its_line_and_column(run, write):
    path = write("a.launch.xml", "<launch>\n  <log message='$(var x)'/></launch>")
    result = run(include(path))
    assert f"{path}:2:3: launch configuration 'x' does not exist" in result.lines[-1]
    path = write("b.launch.yaml", "launch:\n  - executable: {cmd: no-such-program}\n")
    result = run(include(path))
    assert (result.code, f"{path}:2:5: there is no program" in result.text) == (0, True)


def test_text_that_has_no_effect_is_told(run, write):
    result = run(include(write("a.launch.xml", "<launch>\n<log message='a'/> b </launch>")))
    assert "a.launch.xml:2: the text 'b' in <launch> has no effect" in result.text
    assert said(result) == ["a"]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("$(var x)", "1"),
        ("$(var $(var name))", "1"),
        ("$(var none default)", "default"),
        ("$(var none '')", ""),
        ("$(eval '$(var x) + 1')", "2"),
        ("$(eval \"'$(var x)' == '1'\")", "True"),
        ("$(eval 'math.floor(1.5)' math)", "1"),
        ("$(env NO_SUCH_VARIABLE a)b", "ab"),
        ("$(command 'echo a')", "a\n"),
        ("$(not false) $(and true false) $(or true false)", "true false true"),
        ("$(any false true) $(all true true true)", "true true"),
        ("$(equals 1 1.0) $(not-equals a b)", "true true"),
        ("$(if true a b)$(if 0 a b)", "ab"),
        (r"\$(var x) 'q'", "$(var x) 'q'"),
        ("$5 and $ ", "$5 and $ "),
    ],
)
def test_substitutions(text, value):
    context = LaunchContext()
    context.launch_configurations.update(x="1", name="x")
    assert "".join(each.perform(context) for each in parse_substitution(text)) == value


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("$(eval 1 + 1)", "has 3 arguments; eval takes 1 to 2; one with blanks needs quotes"),
        ("$(find robot)", "there is no substitution $(find ...); write $(find-pkg-share PACKAGE)"),
        ("$()", "does not begin with the name"),
        ("$(any)", "any takes 1 or more"),
    ],
)
def test_substitutions_that_mean_nothing(text, words):
    with pytest.raises(SubstitutionFailure) as error:
        parse_substitution(text)
    assert words in str(error.value)


def test_the_names_of_ros_2(write):
    from launch.frontend import Entity, InvalidFrontendLaunchFileError, Parser, expose_action
    from launch_xml import Parser as XMLParser
    from launch_xml.launch_description_sources import XMLLaunchDescriptionSource
    from launch_yaml import Parser as YAMLParser
    from launch_yaml.launch_description_sources import YAMLLaunchDescriptionSource

    path = str(write("a.launch.xml", "<launch><of_mine words='a b' n='3' l='1,2' l-sep=','/></launch>"))
    read = []

    @expose_action("of_mine")
    def parse(entity: Entity, parser: Parser):
        read.extend([entity.get_attr("words"), entity.get_attr("n", data_type=int)])
        read.append(entity.get_attr("l", data_type=list[int]))
        with pytest.raises(AttributeError):
            entity.get_attr("missing")
        with pytest.raises(TypeError):
            entity.get_attr("words", data_type=int, can_be_str=False)
        return IncludeLaunchDescription, {"launch_description_source": "none"}

    root, parser = XMLParser.load(path)
    assert len(parser.parse_description(root).entities) == 1
    assert read == ["a b", 3, [1, 2]]
    assert Parser.is_extension_valid("yaml") and not Parser.is_extension_valid("json")
    with pytest.raises(InvalidFrontendLaunchFileError):
        YAMLParser.load(path)
    assert XMLLaunchDescriptionSource(path).try_get_launch_description_without_context() is not None
    with pytest.raises(LaunchError):
        YAMLLaunchDescriptionSource(path).try_get_launch_description_without_context()


FLAGS = [
    (
        "a.launch.xml",
        "<launch><group scoped='0'><let name='y' value='1'/></group><log message='$(var y)'/></launch>",
        False,
    ),
    ("b.launch.yaml", "launch:\n- group: {scoped: 'false', children: [{log: {message: '1'}}]}\n", True),
    ("c.launch.xml", "<launch><executable cmd='true' shell='$(var x)'/><log message='1'/></launch>", True),
    ("d.launch.xml", "<launch><executable cmd='true' emulate_tty='1' respawn='0'/><log message='1'/></launch>", False),
]


@pytest.mark.parametrize(("name", "text", "warned"), FLAGS)
def test_flags_are_read_as_launch_reads_them(run, write, name, text, warned):
    result = run(include(write(name, text)))
    assert (result.code, said(result)) == (0, ["1"])
    assert ("counts as true whatever it says" in result.text) is warned


@pytest.mark.parametrize("value", ["'false'", '"$(var no)"', "'0'"])
def test_a_timer_of_a_file_outlives_the_shutdown_if_it_says_so(run, write, value):
    text = (
        f"<launch><let name='no' value='false'/><timer period='-1' cancel_on_shutdown={value}>"
        "<log message='late'/></timer><shutdown/></launch>"
    )
    assert said(run(include(write("a.launch.xml", text)))) == ["late"]
