"""Errors of launch files and of xacro: what is said beside the error itself."""

import pytest

from gz_course.grader.feedback.errors.launch_errors import launch_meaning


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (
            "Included launch description missing required argument 'world' (description: 'World')",
            "world', default_value",
        ),
        ("Couldn't parse remap rule: '-r __ns:=/robot{number}'. Error: Expected", "names have no braces"),
        ("Couldn't parse parameter override rule: '-p use_sim_time=true'. Error:", "NAME:=VALUE, with :="),
        ("Couldn't parse remap rule: '-r __ns:=robot3'. Error: Expected", "begins with /: __ns:=/robot3"),
        ("Couldn't parse remap rule: '-r front/odom:=/robot3-1/odom'. Error", "and here is a -"),
        ("rclpy.UnknownROSArgsError: ['use_sim_time:=true']", "-p is missing before use_sim_time:=true"),
        ("make() of OpaqueFunction returned holds [<Node>, <Node>] of type list; only", "append([...]) adds the list"),
        ("there is no option '-x -1.2'; options are: -P", "'-x -1.2' is one word with a space in it"),
        ("TypeError: int() argument must be a string, not 'LaunchConfiguration'", ".perform(context)) is its number"),
        (
            "the Python expression \"'' if false == 'true'\" fails with NameError: name 'false' is not defined",
            "compare in quotes",
        ),
        ("'/submission/watch.py' cannot be started: it is not executable (chmod", "cmd=[sys.executable, PATH"),
        ("AttributeError: 'NoneType' object has no attribute 'perform_substitution'", "got None for its context"),
        ("launch configuration 'word' does not exist", "declares word"),
        ("b.launch.py:3: invalid condition expression: 'paused'; true, false, 1 or 0 is expected", "not its name in"),
        ("AttributeError: 'LaunchConfiguration' object has no attribute 'endswith'", "is no text and has no endswith"),
        ("Unknown substitution command [wheel_radius]. Valid commands are ['find']", "in braces, ${wheel_radius}"),
        ("the command 'xacro robot.urdf.xacro' failed: error: name 'radius' is not defined ", "xacro:property above"),
        (
            "the command 'xacro robot.urdf.xacro' failed with exit code 1: [Errno 2] No such file or directory",
            "str(Path(__file__).parent / 'robot.urdf.xacro')",
        ),
        ("unknown macro name: xacro:wheel", "no xacro:macro above is called wheel"),
        ("XML parsing error: unbound prefix: line 4, column 2", "xmlns:xacro"),
        ("XML parsing error: mismatched tag: line 60, column 4", "</link>"),
        ("[Errno 2] No such file or directory: 'gz sim -s -r lidar_room.sdf'", "each word by itself"),
        ("there is no program 'gz sim -s ' to be started", "each word by itself"),
        ("ImportError: cannot import name 'Node' from 'launch.actions' (/x.py)", "from launch_ros.actions import Node"),
        ("NameError: name 'ExecuteProcess' is not defined", "import of ExecuteProcess is missing: from launch.actions"),
        (
            '/submission/c.launch.py:54: TypeError: can only concatenate str (not "int") to str',
            "int(...) makes a number",
        ),
        ("x.py:3: TypeError: 'str' object cannot be interpreted as an integer", "int(...) makes a number"),
        ("there is no program 'xacro/submission/robot.urdf.xacro' for Command to run", "['xacro ', path]"),
        ("NameError: name 'os' is not defined", "the import of os is missing"),
        ("TypeError: unsupported operand type(s) for /: 'PosixPath' and 'LaunchConfiguration'", "PathJoinSubstitution"),
        ('TypeError: can only concatenate str (not "LaunchConfiguration") to str', "a list joins texts"),
        (
            "TypeError: join() argument must be str, bytes, or os.PathLike object, not 'LaunchConfiguration'",
            "has no value",
        ),
        ("LaunchConfiguration.perform() missing 1 required positional argument: 'context'", "OpaqueFunction"),
        ("PackageNotFoundError: package 'my_bringup' not found, searching: ['/x']", "Path(__file__).parent"),
        ("package 'ros_gz_bridges' not found, searching: ['/x']; did you mean 'ros_gz_bridge'?", ""),
        ("-0.0 is of type float; text, a substitution or a list of them is expected here", "str(...) of a number"),
        ("False is of type bool; text, a substitution or a list of them is expected here", "in quotes"),
        ("the Python expression 'not false' fails with NameError: name 'false' is not defined; text", "IfCondition"),
        (
            "Trying to set parameter 'stop_at' to '1.0' of type 'DOUBLE', expecting type 'INTEGER': stop_at",
            "declare_parameter('stop_at', 1.0)",
        ),
        (
            "Trying to set parameter 'stop_at' to '1' of type 'INTEGER', expecting type 'DOUBLE': stop_at",
            "such as 1.0",
        ),
        (
            "Trying to set parameter 'stop_at' to '1' of type 'STRING', expecting type 'DOUBLE': stop_at",
            "ParameterValue(..., value_type=float)",
        ),
        (
            "TypeError: float() argument must be a string or a real number, not 'LaunchConfiguration'",
            "ParameterValue(..., value_type=float)",
        ),
        (
            "ParameterAlreadyDeclaredException: Parameter(s) already declared: ['use_sim_time']",
            "{'use_sim_time': True}",
        ),
        ("TypeError: Node has no argument 'use_sim_time'; there are: name", "parameters=[{'use_sim_time': True}]"),
        ("NameError: name 'bridge_file' is not defined", ""),
        ("[Errno 2] No such file or directory: 'gz'", ""),
    ],
)
def test_the_meaning_is_named(error, words):
    said = launch_meaning(error)
    assert words in said and bool(words) == bool(said)
