"""Node: the resulting command, and the errors if it cannot be built."""

import stat
from unittest.mock import ANY

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from rclpy.exceptions import InvalidNamespaceException, InvalidNodeNameException
from rclpy.validate_namespace import validate_namespace
from rclpy.validate_node_name import validate_node_name

from gz_course.sim.ros.launch import LaunchContext
from gz_course.sim.ros.launch.actions import (
    EmitEvent,
    GroupAction,
    IncludeLaunchDescription,
    LogInfo,
    RegisterEventHandler,
)
from gz_course.sim.ros.launch.conditions import IfCondition
from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.event_handlers import OnProcessExit, OnProcessStart
from gz_course.sim.ros.launch.events import Shutdown
from gz_course.sim.ros.launch.launch_description_sources import AnyLaunchDescriptionSource
from gz_course.sim.ros.launch.substitutions import LaunchConfiguration, TextSubstitution
from gz_course.sim.ros.launch_ros.actions import (
    ComposableNodeContainer,
    LifecycleNode,
    LoadComposableNodes,
    Node,
    PushROSNamespace,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetUseSimTime,
)
from gz_course.sim.ros.launch_ros.descriptions import ComposableNode, ParameterFile
from gz_course.sim.ros.launch_ros.node_name import check_namespace, check_node_name, joined
from gz_course.sim.ros.launch_ros.parameter_descriptions import Parameter, ParameterValue
from gz_course.sim.ros.launch_ros.substitutions import (
    ExecutableInPackage,
    FindPackage,
    FindPackagePrefix,
    FindPackageShare,
)


def node(**options):
    return Node(package="my_robot", executable="tell", output="screen", **options)


def test_a_bare_node(tell):
    assert tell(node()).words == [["--ros-args"]]


def test_the_order_of_everything(tell, tmp_path):
    (tmp_path / "a.yaml").write_text("a")
    result = tell(
        SetParameter("scoped", 1),
        SetParametersFromFile(str(tmp_path / "a.yaml")),
        SetRemap("/from", "/to"),
        node(
            arguments=["one", LaunchConfiguration("x"), ""],
            ros_arguments=["--log-level", "debug"],
            name="robot",
            namespace="ns",
            parameters=[str(tmp_path / "a.yaml"), Parameter("p", "5"), {"b": 2}],
            remappings=[("scan", "/scan"), (["o", LaunchConfiguration("x")], "d")],
        ),
        x="two",
    )
    file = str(tmp_path / "a.yaml")
    ((*words,),) = result.words
    made = words[words.index("p:='5'") + 2]
    assert words == [
        *("one", "two", "", "--ros-args", "--log-level", "debug", "--ros-args"),
        *("-r", "__node:=robot", "-r", "__ns:=/ns"),
        *("-p", "scoped:=1", "--params-file", file),
        *("--params-file", file, "-p", "p:='5'", "--params-file", made),
        *("-r", "/from:=/to", "-r", "scan:=/scan", "-r", "otwo:=d"),
    ]
    assert made.startswith(str(tmp_path / "temporary/launch_params_"))
    assert yaml.safe_load(result.files[0][2]) == {"/ns/robot": {"ros__parameters": {"b": 2}}}


@pytest.mark.parametrize(
    ("names", "key"),
    [({}, "/**"), ({"name": "n"}, "/**"), ({"namespace": "/a"}, "/**"), ({"name": "n", "namespace": "/"}, "/n"),
     ({"name": "n", "namespace": "a/b"}, "/a/b/n")],
)  # fmt: skip
def test_parameters_are_for_the_node_if_its_full_name_is_known(tell, names, key):
    result = tell(node(parameters=[{"z": 1, "a": {"c": 1, "b": {"d": True}}}], **names))
    (text,) = result.files[0]
    assert text == f"{key}:\n  ros__parameters:\n    a.b.d: true\n    a.c: 1\n    z: 1\n"


@pytest.mark.parametrize(
    ("pushed", "own", "result"),
    [
        (None, None, None),
        (None, "", None),
        (None, "a", "/a"),
        (None, "/a/", "/a"),
        ("/p", None, "/p"),
        ("/p", "a/b", "/p/a/b"),
        ("/p", "/a", "/a"),
        ("/", "a", "/a"),
        (None, "/", "/"),
    ],
)
def test_namespaces_inside_of_others(pushed, own, result):
    assert joined(pushed, own) == result


@given(st.lists(st.sampled_from(["a", "b_1", "/c", "d/e", "/"]), max_size=4))
def test_joined_namespaces_are_those_of_ros(parts):
    context = LaunchContext()
    for part in parts:
        PushROSNamespace(part).visit(context)
    result = context.launch_configurations.get("ros_namespace")
    assert (result is None) == (not parts)
    if result is not None:
        assert validate_namespace(result)


NAMES = st.one_of(
    st.text("ab1_/-~ ", max_size=6),
    st.text(st.characters(blacklist_categories=["Cs"], blacklist_characters="\0"), max_size=6),
    st.integers(240, 260).map(lambda n: "a" * n),
)


@given(NAMES)
def test_node_names_are_checked_as_rclpy_does(name):
    try:
        validate_node_name(name)
        valid = True
    except (InvalidNodeNameException, ValueError):
        valid = False
    try:
        check_node_name(name)
        assert valid
    except LaunchError:
        assert not valid


@given(NAMES.map(lambda name: f"/{name}"))
def test_namespaces_are_checked_as_rclpy_does(namespace):
    try:
        validate_namespace(namespace)
        valid = True
    except (InvalidNamespaceException, ValueError):
        valid = False
    try:
        check_namespace(namespace)
        assert valid
    except LaunchError:
        assert not valid


def test_scopes_end_with_their_group(tell):
    result = tell(
        GroupAction(
            [
                PushRosNamespace("outer"),
                SetRemap("a", "b"),
                SetUseSimTime(True),
                GroupAction([PushRosNamespace("inner"), SetRemap("c", "d"), SetParameter("x", [1, 2.5]), node()]),
                node(arguments=["second"]),
            ]
        ),
        node(arguments=["third"]),
    )
    inner = "--ros-args -r __ns:=/outer/inner -p use_sim_time:=true -p x:=[1.0, 2.5] -r a:=b -r c:=d"
    outer = "second --ros-args -r __ns:=/outer -p use_sim_time:=true -r a:=b"
    assert sorted(" ".join(words) for words in result.words) == sorted([inner, outer, "third --ros-args"])


def test_a_missing_parameter_file_is_told_and_left_out(tell):
    result = tell(SetParametersFromFile("/no/scope.yaml"), node(parameters=["/no/own.yaml"]))
    assert result.words == [["--ros-args"]]
    for name in ("scope", "own"):
        line = f"[WARNING] [launch_ros.actions.node]: Parameter file path is not a file: /no/{name}.yaml"
        assert line in result.text


def test_a_parameter_file_may_hold_substitutions(tell, tmp_path):
    source = tmp_path / "a.yaml"
    source.write_text("# $(nothing\n/**:\n  ros__parameters:\n    a: $(var x)\n    b: '$(env HOME)'\n    c: '5'\n")
    result = tell(node(parameters=[ParameterFile(str(source), allow_substs=True)]), x="3")
    (text,) = result.files[0]
    values = yaml.safe_load(text)["/**"]["ros__parameters"]
    assert (values["a"], values["c"]) == (3, "5")
    assert tell(node(parameters=[ParameterFile(source)])).files == [[source.read_text()]]
    source.write_text("a: [")
    result = tell(node(parameters=[ParameterFile(source, allow_substs=True)]))
    assert result.code == 1 and "is no YAML" in result.text


def test_an_executable_without_a_package_is_looked_for_on_the_path(tell, package, monkeypatch):
    monkeypatch.setenv("PATH", f"{package}/lib/my_robot:/usr/bin:/bin")
    assert tell(Node(executable="tell", output="screen", exec_name="tell")).words == [["--ros-args"]]


def test_its_label(tell):
    result = tell(node(), Node(package="my_robot", executable="tell", exec_name="robot"))
    assert "[INFO] [tell-1]: process started" in result.text
    assert "[INFO] [robot-2]: process started" in result.text


def test_its_names_are_known_afterwards(tell):
    first, second = node(name="a", namespace="b"), node()
    tell(first, second)
    assert (first.node_name, first.is_node_name_fully_specified()) == ("/b/a", True)
    assert second.node_name == "<node_namespace_unspecified>/<node_name_unspecified>"
    assert not second.is_node_name_fully_specified()
    assert (first.expanded_node_namespace, first.expanded_remapping_rules) == ("/b", [])


def test_two_nodes_of_one_name_are_told(tell):
    same = {"name": "a", "namespace": "/"}
    assert "there are now at least 2 nodes with the name /a" in tell(node(**same), node(**same)).text
    assert "at least" not in tell(node(**same), node(name="b", namespace="/")).text


def test_respawned_nodes_keep_their_parameter_files(tell):
    result = tell(node(parameters=[{"a": 1}], respawn=True, respawn_max_retries=1))
    assert len(result.files) == 2 and result.files[0] == result.files[1]


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Node(package="my_robt", executable="tell"), "package 'my_robt' not found, searching: ['"),
        (lambda: Node(package="my_robt", executable="tell"), "; did you mean 'my_robot'?"),
        (lambda: Node(package="my_robot", executable="tel"), "executable 'tel' not found on the libexec directory '"),
        (lambda: Node(package="my_robot", executable="tel"), "; did you mean 'tell'?"),
        (lambda: Node(package="my_robot", executable="text"), "/text' is not executable; chmod +x makes it so"),
        (lambda: Node(package="empty", executable="x"), "but libexec directory '"),
        (lambda: Node(package="/", executable="x"), "package"),
        (lambda: node(name="my robot"), "the node name 'my robot' is not valid"),
        (lambda: node(namespace="1a"), "the namespace '/1a' is not valid"),
        (lambda: PushRosNamespace("a//b"), "the namespace '/a//b' is not valid"),
        (lambda: composed("x::Tell"), "the component 'x::Tell' of 'my_robot' cannot be loaded: containers need a full"),
        (lambda: composed("my::Tel"), "no program is registered that runs it; did you mean 'my::Tell'?"),
        (lambda: LifecycleNode(package="my_robot", executable="tell", name=""), "the name of a LifecycleNode is empty"),
        (lambda: node(parameters=[{"a": LaunchConfiguration("x")}]), "launch configuration 'x' does not exist"),
    ],
)
def test_what_cannot_be_executed_ends_the_launch(tell, package, make, words):
    (package / "lib/my_robot/text").touch()
    (package / "share/ament_index/resource_index/packages/empty").touch()
    result = tell(make())
    assert result.code == 1
    (line,) = (line for line in result.text.splitlines() if "Caught exception" in line)
    assert words in line
    assert f"{__file__}:" in line


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"parameters": {"a": 1}}, "parameters must be a list"),
        ({"parameters": "a.yaml"}, "parameters must be a list"),
        ({"parameters": [3]}, "parameters holds 3 of type int"),
        ({"parameters": [{3: 1}]}, "the parameter name 3 is of type int"),
        ({"parameters": [{"a": None}]}, "the parameter 'a' has the value None of type NoneType"),
        ({"parameters": [{"a": {"b": object()}}]}, "the parameter 'a.b' has the value"),
        ({"parameters": [{"a": []}]}, "is an empty list"),
        ({"parameters": [{"a": [1, "b"]}]}, "list of int, str"),
        ({"arguments": "one two"}, "arguments must be a list"),
        ({"remappings": ["a:=b"]}, "remappings holds 'a:=b'"),
        ({"node_name": "a"}, "Node has no argument 'node_name' any more; did you mean 'name'"),
        ({"outputs": "screen"}, "Node has no argument 'outputs'; did you mean 'output'"),
    ],
)
def test_arguments_that_make_no_sense(options, words):
    with pytest.raises(Exception) as error:
        Node(package="my_robot", executable="tell", **options)
    assert words in str(error.value)


def test_packages_and_what_is_in_them(package, performed):
    assert performed(FindPackageShare("my_robot")) == str(package / "share/my_robot")
    inside = FindPackageShare(["my_", LaunchConfiguration("x")]) / "a"
    assert performed(inside, x="robot") == f"{package}/share/my_robot/a"
    assert performed(FindPackagePrefix("my_robot")) == performed(FindPackage("my_robot")) == str(package)
    tell = package / "lib/my_robot/tell"
    assert performed(ExecutableInPackage(package="my_robot", executable="tell")) == str(tell)
    assert tell.stat().st_mode & stat.S_IXUSR


def test_without_any_prefix_it_says_so(performed, monkeypatch):
    monkeypatch.delenv("AMENT_PREFIX_PATH")
    with pytest.raises(LaunchError, match="AMENT_PREFIX_PATH, which names the folders to search, is not set"):
        performed(FindPackageShare("my_robot"))


def composed(plugin, **options):
    return LoadComposableNodes(
        target_container="container",
        composable_node_descriptions=[ComposableNode(package="my_robot", plugin=plugin, **options)],
    )


def test_composable_nodes_run_as_processes_of_their_own(tell):
    """Each by the program that its package has registered, with what the description says."""
    options = {"name": "a", "parameters": [{"b": 1}], "remappings": [("c", "d")]}
    described = [
        ComposableNode(package="my_robot", plugin="my::Tell", **options),
        ComposableNode(package="my_robot", plugin="no::Such", condition=IfCondition("false")),
    ]
    container = ComposableNodeContainer(
        name="x", namespace="", package="rclcpp_components", executable="component_container",
        composable_node_descriptions=described, output="screen",
    )  # fmt: skip
    result = tell(container, composed("my::Tell", name="later"))
    assert "the nodes of the container 'x' run as processes of their own (1)" in result.text
    assert result.words == [["--ros-args", "-r", "__node:=a", "--params-file", ANY, "-r", "c:=d"]]
    assert result.files == [["/**:\n  ros__parameters:\n    b: 1\n"]]
    assert "[tell-2]: process has finished cleanly" in result.text


def test_parameters_as_values_with_a_type():
    value = ParameterValue(TextSubstitution(text="5"), value_type=str)
    assert (value.value_type, value.evaluate(LaunchContext())) == (str, "5")


@pytest.mark.parametrize(
    ("written", "value"), [("'true'", True), ("'3'", 3), ("3", 3), ("'2.5'", 2.5), ("a b", "a b"), ("'[1, 2]'", [1, 2])]
)
def test_the_text_of_set_parameter_is_yaml_also_in_a_file_of_yaml(tell, tmp_path, written, value):
    (tmp_path / "p.launch.yaml").write_text(f"""\
launch:
- set_parameter: {{name: p, value: {written}}}
- node: {{pkg: my_robot, exec: tell, output: screen}}
""")
    result = tell(IncludeLaunchDescription(AnyLaunchDescriptionSource(str(tmp_path / "p.launch.yaml"))))
    (words,) = result.words
    name, _, text = words[words.index("-p") + 1].partition(":=")
    assert (name, yaml.safe_load(text)) == ("p", value)


def test_an_event_handler_sees_a_container_as_its_nodes(tell):
    nodes = [ComposableNode(package="my_robot", plugin="my::Tell", name=name) for name in ("a", "b")]
    container = ComposableNodeContainer(name="c", namespace="", composable_node_descriptions=nodes, output="screen")
    result = tell(
        RegisterEventHandler(OnProcessStart(target_action=container, on_start=[LogInfo(msg="a start")])),
        RegisterEventHandler(OnProcessExit(target_action=container, on_exit=[LogInfo(msg="the end")])),
        container,
    )
    lines = [line.partition("[launch.user]: ")[2] for line in result.text.splitlines() if "launch.user" in line]
    assert lines == ["a start", "a start", "the end"]
    assert result.text.index("the end") > result.text.rindex("process has finished cleanly")


def test_an_event_handler_of_a_container_without_nodes_waits_in_vain(tell):
    container = ComposableNodeContainer(name="c", namespace="", composable_node_descriptions=[])
    never = OnProcessExit(target_action=container, on_exit=[EmitEvent(event=Shutdown())])
    assert tell(container, RegisterEventHandler(never)).code == 0
