"""Mistakes in launch files, each in a file that is right but for it."""

import pytest

from gz_course.grader.feedback.launch_files import launch_places

RIGHT = """\
import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction, RegisterEventHandler, TimerAction
from launch.conditions import IfCondition, UnlessCondition
from launch.event_handlers import OnProcessExit
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node, SetParameter

HERE = Path(__file__).parent


def later(context):
    if LaunchConfiguration("paused").perform(context) == "true":
        return [ExecuteProcess(cmd=["echo", "it is paused"])]
    return []


def generate_launch_description():
    world, paused = LaunchConfiguration("world"), LaunchConfiguration("paused")
    stands = ExecuteProcess(cmd=["gz", "sim", "-s", world], condition=IfCondition(paused))
    runs = ExecuteProcess(cmd=["gz", "sim", "-s", "-r", world], condition=UnlessCondition(paused))
    create = Node(package="ros_gz_sim", executable="create", arguments=["-name", "robot"])
    bridge = Node(
        package="ros_gz_bridge",
        executable="parameter_bridge",
        parameters=[{"config_file": str(HERE / "bridge.yaml")}],
    )
    watch = ExecuteProcess(
        cmd=[sys.executable, str(HERE / "watch.py"), "--ros-args", "-p", "use_sim_time:=true"],
    )
    after = RegisterEventHandler(OnProcessExit(target_action=create, on_exit=[bridge]))
    return LaunchDescription([
        DeclareLaunchArgument("world", default_value="empty.sdf"),
        DeclareLaunchArgument("paused", default_value="false"),
        stands, runs, create, after,
        TimerAction(period=2.0, actions=[watch]),
        OpaqueFunction(function=later),
    ])
"""


def slips(text):
    return [place["said"] for place in launch_places(text.encode())["launch_slips"]]


def test_a_right_file_has_none():
    found = launch_places(RIGHT.encode())
    assert found["launch_slips"] == found["fixed_worlds"] == []
    assert [(each["name"], each["default"]) for each in found["declared"]] == [
        ("world", "empty.sdf"),
        ("paused", "false"),
    ]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"-s", world]', '"-s", f"{world}"]', "puts a description of the object world into the text"),
        ('"-s", world]', '"-s", str(world)]', "puts a description of the object world into the text"),
        ('"-s", world]', '"-s", "{}".format(world)]', "puts a description of the object world into the text"),
        ('"-s", world]', '"-s", "%s" % world]', "puts a description of the object world into the text"),
        ("    create =", '    if paused == "true":\n        pass\n    create =', "paused == 'true' is decided while"),
        ('"-s", "-r", world]', '"-s", *(["-r"] if not paused else []), world]', "always counts as true"),
        ('.perform(context) == "true":', ".perform(context):", "'false' as well: compare it"),
        ('.perform(context) == "true":', '.perform(context) == "True":', "'true' in lower case, not 'True'"),
        ('.perform(context) == "true":', ".perform(context) is True:", "'true' in lower case, not 'True'"),
        ("IfCondition(paused)", 'LaunchConfigurationEquals("paused", "True")', "'true' in lower case, not 'True'"),
        ("IfCondition(paused)", 'LaunchConfigurationEquals("paused", "true")', ""),
        (
            "IfCondition(paused)",
            "IfCondition(PythonExpression([\"'\", paused, \"' == 'True'\"]))",
            "'true' in lower case, not 'True'",
        ),
        ('world, paused = LaunchConfiguration("world")', "world, paused = sys.argv[1]", "sys.argv is the command"),
        ("stands, runs, create, after", "stands, runs, create, after, bridge", ""),
        ("stands, runs, create, after,", "stands, runs, create,", "after is made here, but it is not in"),
        ("        return [ExecuteProcess", "        [ExecuteProcess", "is made and then dropped"),
        (
            '        return [ExecuteProcess(cmd=["echo", "it is paused"])]\n    return []',
            '        ExecuteProcess(cmd=["echo", "it is paused"])',
            "later returns nothing",
        ),
        ("OpaqueFunction(function=later)", "OpaqueFunction(function=later(None))", "calls the function at once"),
        ("        OpaqueFunction(function=later),\n", "", "later makes actions, but nothing calls it"),
        ("target_action=create", "target_action=runs", "only when gz sim has ended"),
        ("target_action=create", "target_action=bridge", "only when parameter_bridge has ended"),
        (
            "[\"gz\", \"sim\", \"-s\", \"-r\", world], condition=UnlessCondition(paused))\n    create =",
            "command)\n    command = [\"gz\", \"sim\"]\n    print(OnProcessExit(target_action=runs, on_exit=[watch]))\n"
            "    create =",
            "only when gz sim has ended",
        ),
        ('["-name", "robot"]', '["-x", world, "-Y", LaunchConfiguration("yaw")]', ""),
        ('["-name", "robot"]', '["-world", "yard"]', "create waits for the world yard alone"),
        ('["-name", "robot"]', '["-world", world]', ""),
        ('["-name", "robot"]', '["-R", LaunchConfiguration("yaw")]', "-Y is yaw"),
        ('["-name", "robot"]', '[*("-Y", LaunchConfiguration("y"))]', "-y is the place along y"),
        ('["-name", "robot"]', '["-y", LaunchConfiguration("x")]', "here it gets the launch argument x: -x is"),
        ("OnProcessExit(target_action=create, on_exit=", "OnShutdown(on_shutdown=", "happens when the launch ends"),
        ("stands, runs, create, after", "stands, runs, after", "an event handler waits for create, but create itself"),
        ("period=2.0", "period=30.0", "waits 30 s"),
        ('"sim", "-s", world]', '"sim" "-s", world]', 'a comma is missing between "sim" and "-s"'),
        ('["gz", "sim", "-s", world]', '["setsid", "gz", "sim", "-s", world]', "setsid takes the program away"),
        ("create = Node(", 'create = Node(prefix="nohup", ', "nohup takes the program away"),
        ("stands, runs,", "stands, SetParameter('use_sim_time', True), runs,", ""),
        ("create, after,", "create, after, SetParameter('use_sim_time', True),", ""),
        ("create, after,", "create, after, PushRosNamespace('a'),", ""),
        ("function=later),", "function=later), *[PushRosNamespace('a')]", ""),
        ('"-s", world], condition=IfCondition', '"-s", world], condition=UnlessCondition', "no -r, so its world is"),
        ('"-r", world], condition=UnlessCondition', '"-r", world], condition=IfCondition', "UnlessCondition is the"),
        ('"--ros-args", "-p", "use', '"--ros-args -p use', "is one word here"),
        ('"-s", "-r"', '"-s -r"', "'-s', '-r'"),
        ('sys.executable, str(HERE / "watch.py"), "--r', '["python3", "a.py", "-v"], "--r', "is one word"),
        ("use_sim_time:=true", "use_sim_time:=false", "turns simulated time off"),
        ('"-s", world]', '"-s", "$world"]', "$world is a variable of a shell"),
        ('"-s", world]', '"-s", "$HOME"]', ""),
        (
            "bridge = Node(",
            'bridge = ExecuteProcess(cmd=["parameter_bridge", "b.yaml"])\n    bridge = Node(',
            "arguments of parameter_bridge are topics",
        ),
        ('"--ros-args", "-p", ', '" ".join(["--ros-args", "-p"]), ', "join() makes a single word of several"),
        ('str(HERE / "watch.py"), "--ros-args", ', 'f"{HERE}/watch.py --ros-args", ', "file name and --ros-args"),
        ('"--ros-args", "-p", ', '"-p", ', "--ros-args is missing before"),
        ('"--ros-args", "-p", ', '*command, "-p", ', ""),
        ('"--ros-args", "-p", ', '"--ros-args", ', "-p is missing before"),
        ("use_sim_time:=true", "use_sim_time=true", "written NAME:=VALUE"),
        (
            "bridge = Node(",
            'bridge = Node(\n        arguments=["-p", "use_sim_time:=true"],',
            "is no parameter, because they come before --ros-args",
        ),
        ('"--ros-args", "-p", "use_sim', '"_use_sim', "sets no parameter in ROS 2"),
        ('[{"config_file": str(HERE / "bridge.yaml")}]', '[str(HERE / "bridge.yaml")]', "is a file of ROS parameters"),
        ('"config_file"', '"config"', "a parameter called config, which it does not know"),
        (
            ', "--ros-args", "-p", "use_sim_time:=true"],\n    )',
            "],\n    )\n    stands = SetParameter('use_sim_time', True)",
            "Node actions",
        ),
        (
            ', "--ros-args", "-p", "use_sim_time:=true"],\n    )',
            "],\n    )\n    stands = DeclareLaunchArgument('use_sim_time')",
            "is declared, but nothing reads it",
        ),
        (
            ', "--ros-args", "-p", "use_sim_time:=true"],\n    )',
            "],\n        additional_env={'use_sim_time': 'true'},\n    )",
            "and no environment variable",
        ),
        ('parameters=[{"config_file": str(HERE / "bridge.yaml")}]', "arguments=[HERE / 'bridge.yaml']", "are topics"),
        ('parameters=[{"config_file": str(HERE / "bridge.yaml")}]', "arguments=['/clock@a/msg/B[gz.msgs.C']", ""),
        (
            'parameters=[{"config_file": str(HERE / "bridge.yaml")}]',
            "arguments=[f'config_file:={HERE}/bridge.yaml']",
            "config_file:=... is no parameter among the arguments",
        ),
    ],
)  # fmt: skip
def test_a_mistake_is_named(old, new, words):
    assert old in RIGHT
    found = slips(RIGHT.replace(old, new, 1))
    assert (words in "\n".join(found)) and bool(words) == bool(found), found


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("launch_arguments={'gz_args': ['-r -s ', world]}.items()", ""),
        ("launch_arguments=[('gz_args', world)]", ""),
        ("launch_arguments={'gz_args': ['-r -s', world]}.items()", "a space is missing at the end of '-r -s'"),
        ("launch_arguments={'gz_args': ['-r -s', ' ', world]}.items()", ""),
        ("launch_arguments={'world': world, 'paused': 'true'}.items()", "has no argument called world"),
        ("", "gets no gz_args"),
    ],
)
def test_the_argument_of_the_included_simulator(arguments, words):
    source = 'PathJoinSubstitution([FindPackageShare("ros_gz_sim"), "launch", "gz_sim.launch.py"])'
    found = slips(
        f"source = {source}\nworld = 'a.sdf'\nit = IncludeLaunchDescription(source, {arguments})\nprint(it)\n"
    )
    assert (words in "\n".join(found)) and bool(words) == bool(found), found


def test_a_world_that_stands_in_a_command_is_found():
    found = launch_places(RIGHT.replace('"-s", world]', '"-s", "depot.sdf"]').encode())
    assert [place["world"] for place in found["fixed_worlds"]] == ["depot.sdf"]


@pytest.mark.parametrize(
    ("listed", "words"),
    [
        ("Node(executable='a'), SetParameter('use_sim_time', True)", "SetParameter reaches only the actions after it"),
        ("SetParameter('use_sim_time', True), Node(executable='a')", ""),
        ("Node(executable='a'), SetParameter('use_sim_time', True), *others", ""),
    ],
)
def test_what_follows_a_parameter_of_the_scope(listed, words):
    found = slips(f"LaunchDescription([{listed}])\n")
    assert words in "".join(found) and bool(words) == bool(found)


def test_a_command_that_grows_from_program_to_program():
    added = "    command = BASE\n    command += ['-r', f'__ns:=/r{number}']\n    return ExecuteProcess(cmd=command)\n"
    base, made = "BASE = ['python3', 'a.py', '--ros-args']\n", "made = [follower(n) for n in range(3)]\n"
    places = launch_places(f"{base}def follower(number):\n{added}\n{made}".encode())["launch_slips"]
    assert [place["line"] for place in places] == [4] and "command is BASE itself" in places[0]["said"]


def test_what_is_no_python_has_no_places():
    assert launch_places(b"def (") == {}


@pytest.mark.parametrize(
    ("second", "found"), [("'robot'", True), ("'other'", False), ("'robot'], condition=[a", False)]
)
def test_a_robot_that_is_created_twice(second, found):
    text = (
        "LaunchDescription([\n    Node(executable='create', arguments=['-name', 'robot', *('-x', x)]),\n"
        f"    Node(executable='create', arguments=['-name', {second}]),\n])\n"
    )
    said = [place["said"] for place in launch_places(text.encode())["launch_slips"]]
    assert said == (["create makes a second robot here, beside that of line 2: one is enough"] if found else [])


def test_remappings_among_the_words_of_a_command_are_listed():
    text = (
        "Node(namespace='arm', arguments=['a.py', '--ros-args', '-r', 'wall:=/wall', '-r', '__node:=a'])\n"
        "ExecuteProcess(cmd=['python3', 'b.py', '--ros-args', '-r', '__ns:=/leg', '--remap', 'a:=b', '-r', NAME])\n"
    )
    assert launch_places(text.encode())["remappings"] == [
        {"line": 1, "namespace": "arm", "from": "wall", "to": "/wall"},
        {"line": 2, "namespace": "leg", "from": "a", "to": "b"},
    ]


def test_remappings_are_listed_with_the_namespace_of_their_node():
    text = (
        "Node(\n    namespace='/arm', remappings=[('wall', '/wall'), (NAME, 'x')])\nNAME = 'out'\nNode(remappings=3)\n"
    )
    assert launch_places(text.encode())["remappings"] == [
        {"line": 2, "namespace": "arm", "from": "wall", "to": "/wall"},
        {"line": 2, "namespace": "arm", "from": "out", "to": "x"},
    ]


@pytest.mark.parametrize(
    ("old", "new", "conditions"),
    [
        ("world", "world", ["IfCondition(paused)", "UnlessCondition(paused)"]),
        (", condition=UnlessCondition(paused)", "", ["IfCondition(paused)", ""]),
        ("    runs =", "    if world:\n        runs =", ["IfCondition(paused)"]),
        ("stands, runs,", "GroupAction([stands]), runs,", ["IfCondition(paused)", "UnlessCondition(paused)"]),
    ],
)
def test_each_simulator_has_its_condition(old, new, conditions):
    found = launch_places(RIGHT.replace(old, new).encode())["simulators_made"]
    assert [each["condition"] for each in found] == conditions


def test_the_condition_of_a_group_is_that_of_its_simulator():
    inside = RIGHT.replace("stands = ExecuteProcess(", "stands = GroupAction(condition=c, actions=[ExecuteProcess(")
    inside = inside.replace(", condition=IfCondition(paused))", ")])")
    assert launch_places(inside.encode())["simulators_made"][0]["condition"] == "c"


@pytest.mark.parametrize(
    ("program", "words"),
    [
        ("class Watch:\n    pass\nrclpy.spin(Watch())\n", ["watch.py has ended, and it runs as long as the launch"]),
        ("class Watch:\n    def done(self):\n        raise SystemExit\nrclpy.spin(Watch())\n", []),
        ("print(1)\n", []),
        ("def (", []),
    ],
)
def test_an_event_after_the_end_of_a_node_that_spins(program, words):
    waits = RIGHT.replace("target_action=create, on_exit=[bridge]", "target_action=watch, on_exit=[bridge]")
    found = launch_places(waits.encode(), {"watch.py": program.encode()})["launch_slips"]
    assert [word in each["said"] for word, each in zip(words, found, strict=True)] == [True] * len(words), found


def test_a_name_stands_for_its_words():
    named = RIGHT.replace('"--ros-args", "-p", "use_sim_time:=true"', "TIME").replace(
        "HERE =", 'TIME = "--ros-args -p use_sim_time:=true"\nHERE ='
    )
    assert "'--ros-args -p use_sim_time:=true' is one word here" in slips(named)[0]


@pytest.mark.parametrize(
    ("old", "new", "sim_time", "elsewhere"),
    [
        ("world", "world", True, 0),
        (', "--ros-args", "-p", "use_sim_time:=true"', "", False, 0),
        (', "--ros-args", "-p", "use_sim_time:=true"', ", *WORDS", True, 0),
    ],
)
def test_each_program_says_whether_it_mentions_simulated_time(old, new, sim_time, elsewhere):
    (place,) = launch_places(RIGHT.replace(old, new).encode())["programs"]
    assert (place["program"], place["sim_time"], place["elsewhere"]) == ("watch.py", sim_time, elsewhere)


def test_simulated_time_for_another_program_is_told():
    wrong = RIGHT.replace(', "--ros-args", "-p", "use_sim_time:=true"', "").replace(
        '"config_file": ', '"use_sim_time": True, "config_file": '
    )
    (place,) = launch_places(wrong.encode())["programs"]
    assert (place["sim_time"], place["executable"]) == (False, "parameter_bridge") and place["elsewhere"]


def test_the_default_of_a_configuration_that_nothing_declares_counts():
    text = RIGHT.replace('LaunchConfiguration("paused")\n', 'LaunchConfiguration("paused", default="true")\n')
    assert [each["default"] for each in launch_places(text.encode())["declared"]] == ["empty.sdf", "false"]
    undeclared = text.replace('        DeclareLaunchArgument("paused", default_value="false"),\n', "")
    assert [each["default"] for each in launch_places(undeclared.encode())["declared"]] == ["empty.sdf", "true"]


def test_a_bridge_has_its_condition():
    assert [each["condition"] for each in launch_places(RIGHT.encode())["bridges_made"]] == [""]
    kept = RIGHT.replace('executable="parameter_bridge",', 'executable="parameter_bridge", condition=IfCondition(a),')
    assert [each["condition"] for each in launch_places(kept.encode())["bridges_made"]] == ["IfCondition(a)"]


@pytest.mark.parametrize(
    ("expression", "named"),
    [
        ("[\"'-r' if '\", paused, \"' else ''\"]", True),
        ('["not \'", paused, "\'"]', True),
        ("[\"'-r' if '\", paused, \"' == 'true' else ''\"]", False),
        ("[\"'\", world, \"'.removesuffix('.sdf')\"]", False),
    ],
)
def test_a_text_in_an_expression_is_no_truth(expression, named):
    found = slips(RIGHT.replace('"-r", world', f"PythonExpression({expression}), world"))
    assert any("whether a text in quotes is true" in each for each in found) == named


@pytest.mark.parametrize(
    ("parameters", "sim_time"), [("[HERE / 'watch.yaml']", True), ("[{'speed': 1.0}]", False), ("[]", False)]
)
def test_a_parameter_file_may_hold_simulated_time(parameters, sim_time):
    begin, end = RIGHT.index("watch = ExecuteProcess("), RIGHT.index("after = Register")
    node = f"watch = Node(executable=str(HERE / 'watch.py'), parameters={parameters})\n    "
    (place,) = launch_places((RIGHT[:begin] + node + RIGHT[end:]).encode())["programs"]
    assert place["sim_time"] == sim_time


def test_an_argument_that_is_declared_behind_the_function_that_asks_for_it():
    declared = '        DeclareLaunchArgument("paused", default_value="false"),\n'
    late = RIGHT.replace(declared, "").replace("function=later),\n", f"function=later),\n{declared}")
    assert "paused is declared here, behind the OpaqueFunction" in slips(late)[0]
