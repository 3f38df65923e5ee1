"""Explanations for errors of launch files, of xacro and of bridges whose own text does not say what to change.

Source: the keys and values of ros_gz_bridge 1.0 (Jazzy), ros_gz_bridge/README.md.

Source: the error texts of `launch` 3.4, `launch_ros` 0.26 and `xacro` 2.1, which are those of ROS 2 Jazzy.
"""

from __future__ import annotations

import re

from gz_course.grader.feedback.errors import listed, table
from gz_course.grader.feedback.rules import guarded

# Pattern of an error -> what is mistaken. {0} is the first group of the pattern.
OF_BRIDGES = table(r"""
'(?:[^' ]*)([,;])' is |\S([,;]) is not a ROS message type|cannot become \S*([,;])(?:;|$)|must be .*, not \S*([,;])$
    the {0} at the end is taken for a part of the value: YAML needs nothing at the end of a line, which ends a value by
    itself
cannot become ((?:gz|ignition)::\S+::\w+)|conversion is known for ((?:gz|ignition)::\S+)
    {0} is the name of a class in C++; this file writes Gazebo's types with dots, gz.msgs.NAME
(\w+::(?:msg::)?\w+) is not a ROS message type
    {0} is the name of a class in C++; this file writes it with slashes, package/msg/Name
the direction '([\[\]@])' is none of
    {0} belongs to the topics on the command line of parameter_bridge; in this file, the direction is one of these words
expected a bridge .*found the text '([^']*@[^']*)'
    that is how a bridge is given on the command line; in this file, each of its parts has a key of its own
found the text '\w+ ?(=)
    between a key and its value stand a colon and a space in YAML, and no {0}
expected <block end>, but found '(?:\?|<block)[^;]*$
    a line is indented differently from those it belongs to: all keys of one entry begin in the same column
""")
# Module of each name that launch files import.
MODULES = {
    "launch": ("LaunchDescription", "LaunchService"),
    "launch.actions": (
        "DeclareLaunchArgument", "EmitEvent", "ExecuteProcess", "GroupAction", "IncludeLaunchDescription", "LogInfo",
        "OpaqueFunction", "RegisterEventHandler", "SetEnvironmentVariable", "SetLaunchConfiguration", "Shutdown",
        "TimerAction",
    ),
    "launch.conditions": ("IfCondition", "LaunchConfigurationEquals", "UnlessCondition"),
    "launch.event_handlers": ("OnProcessExit", "OnProcessIO", "OnProcessStart", "OnShutdown"),
    "launch.launch_description_sources": ("PythonLaunchDescriptionSource", "AnyLaunchDescriptionSource"),
    "launch.substitutions": (
        "Command", "EnvironmentVariable", "FindExecutable", "LaunchConfiguration", "PathJoinSubstitution",
        "PythonExpression", "TextSubstitution", "ThisLaunchFileDir",
    ),
    "launch_ros.actions": ("Node", "PushRosNamespace", "SetParameter", "SetRemap", "SetUseSimTime"),
    "launch_ros.parameter_descriptions": ("ParameterFile", "ParameterValue"),
    "launch_ros.substitutions": ("FindPackageShare", "FindPackagePrefix"),
    "ament_index_python.packages": ("get_package_share_directory",),
    "pathlib": ("Path",),
}  # fmt: skip
NOT_IMPORTED = re.compile(r"(?:NameError: name|ImportError: cannot import name) '(\w+)'")
# Pattern of an error -> what to change. {0} is the first group of the pattern.
MEANINGS = table(r"""
\.py' cannot be started: it is not executable
    a Python file is started by Python, ExecuteProcess(cmd=[sys.executable, PATH, ...])
UnknownROSArgsError: \['([\w.]+:=[^']*)'
    -p is missing before {0}: behind --ros-args, a parameter is two words, -p NAME:=VALUE, and a remapping is -r
    FROM:=TO
of OpaqueFunction returned holds \[.*of type list
    a list stands in the list that it returns: actions += [...] and actions.extend([...]) add the items of a list,
    actions.append([...]) adds the list itself
there is no option '(--?\w+) ([^']+)'
    '{0} {1}' is one word with a space in it: '{0}' and its value are two items of the list
Couldn't parse parameter override rule: '-p ([^']*)'
    {0} sets no parameter: after -p comes NAME:=VALUE, with := and no spaces, such as use_sim_time:=true
Couldn't parse remap rule: '-r __ns:=([^/'{}][^']*)'
    a namespace begins with /: __ns:=/{0}
Couldn't parse remap rule: '-r ([^'{} ]+:=[\w/]*-[^'{} ]*)'
    {0} is no remapping: the names of ROS consist of letters, digits, _ and /, and here is a -
Couldn't parse remap rule: '-r ([^']*)'
    {0} is no remapping: after -r comes FROM:=TO, with := and no spaces; names have no braces, and that of a node has no
    /
Couldn't parse params file: '--params-file \S*?([\w.-]*bridge[\w.-]*)'
    {0} is the bridge's own file and no file of ROS parameters: it is the value of the parameter config_file
Trying to set parameter '(\w+)' to '.*' of type 'STRING', expecting type '(?:DOUBLE|INTEGER|BOOL)'
    {0} is passed as a text; ParameterValue(..., value_type=float), or int or bool, makes a value of another type of it
(?:float|int)\(\) argument must be .*LaunchConfiguration
    a LaunchConfiguration has no value while the description is made, so Python cannot convert it: in the function of an
    OpaqueFunction, int(LaunchConfiguration('NAME').perform(context)) is its number; for a parameter of a node,
    ParameterValue(..., value_type=float) converts it when the launch runs
Node has no argument 'use_sim_time'
    use_sim_time is a parameter of the node: parameters=[{{'use_sim_time': True}}]
missing required argument '([^']+)'
    an argument without default_value must be given in every call: DeclareLaunchArgument('{0}', default_value='...')
launch configuration '([^']+)' does not exist
    no action before this one declares {0}: it needs a DeclareLaunchArgument of the same name, above what uses it
(?:unsupported operand|can only concatenate|argument must be|PathLike object).*LaunchConfiguration
    a LaunchConfiguration has no value while the description is made, so Python cannot join it with anything:
    PathJoinSubstitution([...]) joins the parts of a path when the launch runs, and a list joins texts
TypeError: (?:can only concatenate str \(not \"int\"\) to str|'str' object cannot be interpreted as an integer|
'[<>]=?' not supported between instances of '(?:str|int)' and '(?:str|int)')
    one of the two is a text, and the value of a launch argument always is: LaunchConfiguration(...).perform(context)
    gives '3', and int(...) makes a number of it
there is no program 'xacro/
    Command joins its parts as they are, and the space after xacro is missing: ['xacro ', path]
'LaunchConfiguration' object has no attribute '(?!perform)(\w+)'
    a LaunchConfiguration is no text and has no {0}: its value is known when the launch runs, where the function of an
    OpaqueFunction gets it with perform(context)
invalid condition expression: '(\w+)'
    the condition gets the text {0}, which is neither true nor false; the value of an argument is
    LaunchConfiguration('NAME'), not its name in quotes
'NoneType' object has no attribute 'perform_substitution'
    perform() got None for its context: only the function of an OpaqueFunction gets one; elsewhere the
    LaunchConfiguration itself is passed, as an item of the list
perform\(\) missing 1 required positional argument: 'context'
    perform(context) gives the text of a configuration while the launch runs, inside of the function of an
    OpaqueFunction, which gets the context; elsewhere, the LaunchConfiguration itself is passed
: package '[\w-]+' not found(?!.*did you mean)
    only what is built and installed is a package, and none of this name is. A file beside the launch file is reached by
    Path(__file__).parent, and a Python file is started by its path
(?:False|True|None) is of type (?:bool|NoneType); text
    values of launch arguments are texts: default_value='false', in quotes
-?[\d.e-]+ is of type (?:int|float); text
    values of launch arguments and words of a command are texts: '0.5' in quotes, or str(...) of a number
the Python expression ['\"].*['\"] fails with NameError: name '(true|false)' is not defined
    the value of an argument is put into the expression as it was typed, and Python writes True and False: use
    IfCondition or UnlessCondition, or compare in quotes, ["'", value, "' == 'true'"]
Trying to set parameter '(\w+)' to '.*' of type '\w+', expecting type 'INTEGER'
    a parameter has the type of its default value, and here that is a whole number: declare_parameter('{0}', 1.0), with
    a point, takes any number
Trying to set parameter '(\w+)' to '.*' of type 'INTEGER', expecting type 'DOUBLE'
    {0} is passed as a whole number, and the node wants one with a point, such as 1.0
ParameterAlreadyDeclared.*'use_sim_time'
    every node declares use_sim_time itself; it is set where the node is started, parameters=[{{'use_sim_time': True}}],
    and not declared again
(?s)command 'xacro (?!/)([\w./-]+)[^']*' failed.*No such file or directory
    {0} was looked for in the folder in which ros2 launch was called, not beside the launch file: give its full path,
    str(Path(__file__).parent / '{0}')
Unknown substitution command \[(\w+)
    in xacro, $(...) calls a command; the value of a property is written in braces, ${{{0}}}
(?s)(?:xacro.*|^)name '(\w+)' is not defined
    no xacro:property above, and no parameter of this macro, is called {0}
unknown macro name: (?:xacro:)?(\w+)
    no xacro:macro above is called {0}
(?:unbound prefix|Undeclared namespace prefix)
    the root of the file lacks the name of xacro: <robot xmlns:xacro="http://www.ros.org/wiki/xacro">
mismatched tag|not well-formed|no element found
    the file is no valid XML: every tag that begins must end, <link ...> with </link>
(?:No such file or directory: |there is no program )'([\w/.-]+ [^']*)'
    the whole command line is one word of the list: cmd takes each word by itself, ['gz', 'sim', ...]
""")


@guarded("")
def bridge_meaning(error: str) -> str:
    """Return what is mistaken for what, given the text of an error; empty if it is unknown."""
    for pattern, words in OF_BRIDGES:
        if match := pattern.search(error):
            return words.format(next((group for group in match.groups() if group), ""))
    return ""


@guarded("")
def launch_meaning(error: str) -> str:
    """Return what to change, given the text of an error; empty if it is unknown."""
    if match := NOT_IMPORTED.search(error):
        module = next((module for module, names in MODULES.items() if match[1] in names), "")
        what = (
            f"{match[1]} comes from another module"
            if "ImportError" in error
            else f"the import of {match[1]} is missing"
        )
        if module:
            return f"{what}: from {module} import {match[1]}"
        if match[1] in ("math", "os", "sys"):
            return what
    return listed(error, MEANINGS)
