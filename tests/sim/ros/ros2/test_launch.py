"""`ros2 launch`: finding the file, arguments, options, exit codes, and a robot that is driven."""

import re
import shutil
import signal
import subprocess
import sys
import uuid
from pathlib import Path

import psutil
import pytest

SEEDS = Path(__file__).parents[5] / "shared/seeds/code"
HEAD = """\
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import *
from launch.launch_description_sources import *
from launch.substitutions import *
from launch_ros.actions import *
from launch_ros.substitutions import *


def generate_launch_description():
"""


@pytest.fixture(autouse=True)
def log_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros_log"))
    return tmp_path / "ros_log"


@pytest.fixture
def gz(monkeypatch):
    """Return a Gazebo partition that no other program uses."""
    monkeypatch.setenv("GZ_IP", "127.0.0.1")
    monkeypatch.setenv("GZ_PARTITION", uuid.uuid4().hex)


@pytest.fixture
def write(tmp_path):
    """Write a launch file with these entities; return its path."""

    def write(entities, name="robot.launch.py"):
        path = tmp_path / name
        path.write_text(f"{HEAD}    return LaunchDescription([{entities}])\n")
        return str(path)

    return write


@pytest.fixture
def package(workspace, tmp_path):
    """Return the package my_robot with two launch files, and the environment that contains it."""
    share = tmp_path / "install/share/my_robot"
    for name in ("launch/drive.launch.py", "launch/more/twin.launch.py", "other/twin.launch.py"):
        path = share / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"{HEAD}    return LaunchDescription([LogInfo(msg='this is {name}')])\n")
    return workspace("driver", '#!/bin/sh\necho "<$*>"\n')


def after_greeting(text):
    """Return the lines after the two at the beginning of every launch."""
    first, second, *rest = text.splitlines()
    assert first.startswith("[INFO] [launch]: All log files can be found below ")
    assert second == "[INFO] [launch]: Default logging verbosity is set to INFO"
    return rest


def test_a_file_of_a_package(ros2, package):
    code, text, errors = ros2("launch", "my_robot", "drive.launch.py", environment=package)
    assert (code, errors) == (0, "")
    assert after_greeting(text) == ["[INFO] [launch.user]: this is launch/drive.launch.py"]


def test_a_file_by_its_path_and_its_arguments(ros2, write):
    path = write(
        'DeclareLaunchArgument("a"), DeclareLaunchArgument("b", default_value="2"), '
        'LogInfo(msg=[LaunchConfiguration("a"), "|", LaunchConfiguration("b"), "|", LaunchConfiguration("c")])'
    )
    arguments = ["a:=x:=y z", "c:=1", "c:=2", "b:=-r -s"]
    code, text, errors = ros2("launch", path, *arguments)
    assert (code, errors) == (0, "")
    assert after_greeting(text)[-1] == "[INFO] [launch.user]: x:=y z|-r -s|2"


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["my_robt", "drive.launch.py"], "Package 'my_robt' not found: \"package 'my_robt' not found, searching: ["),
        (["my_robt", "drive.launch.py"], "; did you mean 'my_robot'?"),
        (["my_robot", "drve.launch.py"], "file 'drve.launch.py' was not found in the share directory of package "),
        (["my_robot", "drve.launch.py"], "; did you mean 'drive.launch.py'?"),
        (["my_robot", "twin.launch.py"], "was found more than once in the share directory of package 'my_robot': ['"),
        (["{}/robt.launch.py"], "there is no launch file '{}/robt.launch.py'; did you mean 'robot.launch.py'?"),
        (["{}/robot.launch.py", "a=1"], "malformed launch argument 'a=1', expected format '<name>:=<value>'"),
        (["{}/robot.launch.py", ":=1"], "malformed launch argument ':=1', expected format '<name>:=<value>'"),
        (["{}/robot.launch.py", "a:="], "malformed launch argument 'a:=', expected format '<name>:=<value>'"),
        (["-s", "{}/broken.launch.py"], "{}/broken.launch.py:1: SyntaxError"),
    ],
)
def test_what_cannot_be_launched_is_exit_code_1(ros2, package, write, tmp_path, arguments, sentence):
    write("")
    (tmp_path / "broken.launch.py").write_text("def")
    code, text, errors = ros2("launch", *[word.format(tmp_path) for word in arguments], environment=package)
    assert (code, text) == (1, "")
    assert sentence.format(tmp_path) in errors
    assert errors.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "missing"),
    [
        (["my_robot"], "launch_file_name; 'my_robot' has drive.launch.py, twin.launch.py\n"),
        (["my_robt"], "launch_file_name; did you mean 'my_robot'?\n"),
        (
            ["{}/robot.launch.py", "--launch-prefix-filter", "x"],
            "--launch-prefix, which --launch-prefix-filter restricts",
        ),
    ],
)
def test_a_missing_argument_is_wrong_usage(ros2, package, write, tmp_path, arguments, missing):
    write("")
    code, text, errors = ros2("launch", *[word.format(tmp_path) for word in arguments], environment=package)
    assert (code, text) == (2, "")
    assert f"\nros2 launch: error: the following arguments are required: {missing}" in errors


@pytest.mark.parametrize(
    ("entities", "sentence"),
    [
        ("robot", "{}/robot.launch.py:12: NameError: name 'robot' is not defined"),
        ('DeclareLaunchArgument("x")', "Included launch description missing required argument 'x'"),
        ('Node(package="my_robot", executable="drivr")', "{}/robot.launch.py:12: executable 'drivr' not found"),
        ('Node(package="my_robt", executable="driver")', "; did you mean 'my_robot'?"),
        ('ExecuteProcess(cmd=["true"]), OpaqueFunction(function=lambda c: 1 / 0)', "ZeroDivisionError"),
    ],
)
def test_a_launch_that_fails_is_one_line_and_exit_code_1(ros2, package, write, tmp_path, entities, sentence):
    code, text, errors = ros2("launch", write("\n" + entities), environment=package)
    assert (code, errors) == (1, "")
    (line,) = after_greeting(text)
    assert line.startswith("[ERROR] [launch]: Caught exception in launch (see debug for traceback): ")
    assert sentence.format(tmp_path) in line


def test_debug_shows_the_traceback(ros2, write):
    code, text, _ = ros2("launch", "--debug", write("OpaqueFunction(function=lambda context: 1 / 0)"))
    assert code == 1
    assert "[DEBUG] [launch]: Traceback (most recent call last):" in text


def test_its_arguments_are_shown(ros2, write, tmp_path):
    write('DeclareLaunchArgument("inner", description="deep inside")', "inner.launch.py")
    path = write(
        'DeclareLaunchArgument("world", default_value="empty.sdf", description="what to load"), '
        'DeclareLaunchArgument("kind", default_value=[LaunchConfiguration("x"), "y", EnvironmentVariable("Z")], '
        'choices=["a", "b"]), '
        f"IncludeLaunchDescription(PythonLaunchDescriptionSource({str(tmp_path / 'inner.launch.py')!r})), "
        'GroupAction([DeclareLaunchArgument("rare")], condition=IfCondition("true"))'
    )
    code, text, errors = ros2("launch", path, "--show-args")
    assert (code, errors) == (0, "")
    assert (
        text
        == """\
Arguments (pass arguments as '<name>:=<value>'):

    'world':
        what to load
        (default: 'empty.sdf')

    'kind':
        One of: ['a', 'b']
        (default: LaunchConfig('x') + 'y' + EnvVar('Z'))

    'inner':
        deep inside

    'rare':*
        no description given

* argument(s) which are only used if specific conditions occur
"""
    )
    assert ros2("launch", "-s", write(""))[1].endswith("\n\n  No arguments.\n")


def test_it_is_printed(ros2, write):
    code, text, errors = ros2("launch", "-p", write('LogInfo(msg="a"), Node(package="p", executable="e")'))
    assert (code, errors) == (0, "")
    first, second, third = text.splitlines()
    assert first.startswith("<launch.launch_description.LaunchDescription object at ")
    assert second == "├── LogInfo('a')"
    assert third == (
        "└── ExecuteProcess(cmd=[ExecInPkg(pkg='p', exec='e'), '--ros-args'], cwd=None, env=None, shell=False)"
    )


def test_all_output_and_prefixes(ros2, package, write):
    path = write('Node(package="my_robot", executable="driver"), ExecuteProcess(cmd=["echo", "plain"])')
    _, text, _ = ros2("launch", path, environment=package)
    assert "[driver-1] <" not in text
    options = ["-a", "--launch-prefix", "env A=1", "--launch-prefix-filter", "dri.*"]
    code, text, _ = ros2("launch", *options, path, environment=package)
    assert code == 0
    assert "[env-1] <--ros-args>" in text
    assert "[echo-2] plain" in text


def test_help(ros2):
    code, text, errors = ros2("launch", "--help")
    assert (code, errors) == (0, "")
    for option in ("--noninteractive", "--debug", "--print", "--show-args", "--launch-prefix", "launch_arguments"):
        assert option in text


def test_what_children_print_is_seen_when_it_is_printed(start, write):
    code = "print('up'); import signal; signal.pause()"
    path = write(f"ExecuteProcess(cmd=[{sys.executable!r}, '-c', {code!r}], output='screen', name='child')")
    command = start("launch", path)
    command.wait_for("[child-1] up")
    command.process.send_signal(signal.SIGINT)
    code, text, _ = command.wait()
    assert code == 0
    assert "[INFO] [child-1]: sending signal 'SIGINT' to process[child-1]" in text  # there is no terminal


def test_on_a_terminal_ctrl_c_needs_no_explanation(start, write):
    path = write(
        "ExecuteProcess(cmd=['sh', '-c', 'echo up; exec sleep 1000'], output='screen'), "
        "ExecuteProcess(cmd=['sh', '-c', 'trap \"\" INT; echo up; exec sleep 1000'], output='screen', name='stubborn', "
        "sigterm_timeout='0.1')"
    )
    terminal = (
        sys.executable,
        "-c",
        "import os, pty, sys; sys.exit(os.waitstatus_to_exitcode(pty.spawn(sys.argv[1:])))",
    )
    command = start(
        *(sys.executable, "-m", "gz_course.sim.ros.ros2", "launch", path), command=terminal, stdin=subprocess.PIPE
    )
    command.wait_for("[sh-1] up")
    command.wait_for("[stubborn-2] up")
    command.process.stdin.write("\x03")
    command.process.stdin.flush()
    code, text, _ = command.wait()
    assert code == 0
    assert "[WARNING] [launch]: user interrupted with ctrl-c (SIGINT)" in text
    assert "sending signal 'SIGINT'" not in text
    assert "[INFO] [stubborn-2]: sending signal 'SIGTERM' to process[stubborn-2]" in text
    assert re.search(r"process has died \[pid \d+, exit code -2", text)


def test_sigterm_leaves_no_orphan(start, write):
    entities = ", ".join(["ExecuteProcess(cmd=['sh', '-c', 'echo up; exec sleep 1000'], output='screen')"] * 3)
    command = start("launch", write(entities))
    for number in (1, 2, 3):
        command.wait_for(f"[sh-{number}] up")
    children = psutil.Process(command.process.pid).children(recursive=True)
    assert len(children) == 4  # three, and the shell of orphan_watch
    command.process.send_signal(signal.SIGTERM)
    code, text, _ = command.wait()
    assert code == 1
    assert "[WARNING] [launch]: received SIGTERM: shutting down" in text
    assert psutil.wait_procs(children, 0)[1] == []


def test_a_second_ctrl_c_is_heard_and_ignored(start, write):
    stubborn = "trap 'echo heard' INT; echo up; while :; do sleep 1000 & wait $!; done"
    path = write(f"ExecuteProcess(cmd=['sh', '-c', {stubborn!r}], output='screen', sigterm_timeout='0.3')")
    command = start("launch", path)
    command.wait_for("[sh-1] up")
    command.process.send_signal(signal.SIGINT)
    command.wait_for("[sh-1] heard")
    command.process.send_signal(signal.SIGINT)
    code, text, _ = command.wait()
    assert code == 0
    assert "user interrupted with ctrl-c (SIGINT) again, ignoring..." in text
    assert text.count("[sh-1] heard") == 1, "the second one is not passed on"


# Simulator, bridge and a node together

DRIVER = """\
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.speed = self.declare_parameter("speed", 0.0).value
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.look, 10)
        self.create_timer(0.05, self.drive)

    def drive(self):
        message = Twist()
        message.linear.x = self.speed
        self.publisher.publish(message)

    def look(self, message):
        if message.pose.pose.position.x > 0.1:
            print("the robot has moved")


rclpy.init()
try:
    rclpy.spin(Driver())
except KeyboardInterrupt:
    pass
"""
DRIVE = """
    gazebo = IncludeLaunchDescription(
        PythonLaunchDescriptionSource([FindPackageShare("ros_gz_sim"), "/launch/gz_sim.launch.py"]),
        launch_arguments={"gz_args": LaunchConfiguration("world")}.items(),
    )
    bridge = Node(
        package="ros_gz_bridge",
        executable="parameter_bridge",
        arguments=[
            "/model/robot/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist",
            "/model/robot/odometry@nav_msgs/msg/Odometry[gz.msgs.Odometry",
        ],
        remappings=[("/model/robot/cmd_vel", "/cmd_vel"), ("/model/robot/odometry", "/odom")],
        output="screen",
    )
    driver = Node(package="my_robot", executable="driver", parameters=[{"speed": 0.5}], output="screen")
    world = DeclareLaunchArgument("world", default_value="empty.sdf")
    return LaunchDescription([world, gazebo, bridge, driver])
"""


def test_simulator_bridge_and_node_drive_a_robot_and_end_together(start, workspace, tmp_path, ros_domain, gz):
    environment = workspace("driver", f"#!{sys.executable}\n{DRIVER}")
    path = tmp_path / "drive.launch.py"
    path.write_text(HEAD + DRIVE)
    command = start("launch", str(path), "world:=-r -s lidar_room.sdf", environment=environment)
    command.wait_for("[driver-3] the robot has moved")
    children = psutil.Process(command.process.pid).children(recursive=True)
    assert len(children) == 4  # three, and the shell of orphan_watch
    command.process.send_signal(signal.SIGINT)
    code, text, errors = command.wait()
    assert (code, errors) == (0, "")
    assert psutil.wait_procs(children, 0)[1] == []
    for label in ("gazebo-1", "parameter_bridge-2", "driver-3"):
        assert f"[INFO] [{label}]: process has finished cleanly" in text
    assert "escalating" not in text


@pytest.mark.skipif(not SEEDS.is_dir(), reason="the textbook's files are not here")
def test_the_textbook_runs_as_printed(start, tmp_path, ros_domain, gz):
    from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_WORLDS

    shutil.copy(BUILT_IN_WORLDS / "lidar_room.sdf", tmp_path / "my_first_world.sdf")
    path = SEEDS / "sim_with_bridge.launch.py"
    command = start("launch", str(path), "world:=my_first_world.sdf", cwd=tmp_path)
    command.wait_for("ready: 4 bridges")
    command.wait_for("is paused; start it with -r")
    command.process.send_signal(signal.SIGINT)
    code, text, errors = command.wait()
    assert (code, errors) == (0, "")
    assert text.count("process has finished cleanly") == 2


@pytest.mark.skipif(not SEEDS.is_dir(), reason="the skill page's file is not here")
def test_the_faulty_launch_file_is_repaired_step_by_step_by_what_is_said(ros2, start, tmp_path, ros_domain, gz):
    path = tmp_path / "spawn_robot.launch.py"
    text = (SEEDS / "spawn_robot.launch.py").read_text()

    def said():
        path.write_text(text)
        code, output, _ = ros2("launch", str(path), cwd=tmp_path)
        assert code == 1
        return after_greeting(output)

    (line,) = said()
    assert line.endswith("spawn_robot.launch.py:44: NameError: name 'robot_description' is not defined")
    text = text.replace("robot_description}", "'<robot/>'}")
    (line,) = said()
    assert "there is no launch file 'gz_sim.launch.py' in the current folder" in line
    repair = 'PathJoinSubstitution([FindPackageShare("ros_gz_sim"), "launch", "gz_sim.launch.py"])'
    assert line.endswith(f"the package ros_gz_sim has one of that name: write {repair}")
    text = text.replace("[\n                'gz_sim.launch.py'\n            ]", repair)
    text = text.replace("def generate", f"{HEAD.split('def', maxsplit=1)[0]}def generate")
    path.write_text(text)
    command = start("launch", str(path), cwd=tmp_path)
    command.wait_for("[WARNING] [launch]: 'world' is not an argument of ")
    command.wait_for("its arguments are: debugger, gz_args")
    command.process.send_signal(signal.SIGINT)
    assert command.wait()[2] == ""
