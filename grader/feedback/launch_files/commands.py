"""Words of commands and parameters of nodes that programs do not read as they were meant.

Source: https://design.ros2.org/articles/ros_command_line_arguments.html
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.launch_files import launch_slip
from gz_course.grader.feedback.launch_files.reading import LaunchFile, Place, argument, text
from gz_course.grader.feedback.launch_files.ros_arguments import command_words
from gz_course.grader.feedback.launch_files.stated import texts_of

SIM_TIME = "use_sim_time"
OPTION = re.compile(r"--?[a-zA-Z]")
DETACH = frozenset({"setsid", "nohup", "disown", "tmux", "screen", "&"})
STARTS_NODES = frozenset({"?", "Node", "LifecycleNode", "GroupAction", "IncludeLaunchDescription", "OpaqueFunction"})


def _commands(file: LaunchFile) -> Iterator[list[ast.expr]]:
    """Yield the words of every command that is a list, and is not one for a shell."""
    for call in file.calls("ExecuteProcess", "ExecuteLocal", "Node"):
        node = last_name(call.func) == "Node"
        given = file.value(argument(call, "arguments") if node else argument(call, "cmd"))
        shell = argument(call, "shell")
        if isinstance(given, ast.List) and not (isinstance(shell, ast.Constant) and shell.value):
            yield given.elts


@launch_slip
def glued_words(file: LaunchFile) -> Iterator[Place]:
    """Find several words of a command line in one item of the list."""
    for words in _commands(file):
        for word in _spread(words):
            said = text(file.value(word))
            parts = said.split()
            if len(parts) > 1 and OPTION.match(parts[0]):
                apart = ", ".join(repr(part) for part in parts)
                yield (
                    word.lineno,
                    f"{said.strip()!r} is one word here, with spaces in it: the program gets it as a single "
                    f"argument. Each word is an item of its own: {apart}",
                )
            elif glued := _option_and_value(file.value(word)):
                yield (
                    word.lineno,
                    f"{unparse(word)[:60]} is one word here, with a space in it: the program gets it as a single "
                    f"argument, which it does not know. {glued} and its value are two items of the list",
                )
            elif isinstance(word, ast.BinOp | ast.JoinedStr) and any("--ros-args" in text(e) for e in walk(word)):
                yield (
                    word.lineno,
                    "file name and --ros-args are one word here, with spaces in it: each word of a command is an item "
                    "of its own in the list",
                )
            elif isinstance(inner := file.value(word), ast.List) and any(
                OPTION.match(text(each)) for each in inner.elts[1:]
            ):
                yield (
                    word.lineno,
                    "a list inside of the list is one word: launch joins its parts without spaces. Each word of a "
                    "command is an item of the outer list",
                )
            elif _joined(file.value(word)):
                yield (
                    word.lineno,
                    "join() makes a single word of several, with spaces in it: each word of a command is an item of "
                    "its own in the list",
                )


def _spread(words: list[ast.expr]) -> Iterator[ast.expr]:
    """Yield the words of a command, those that a star puts into it among them."""
    for each in words:
        inside = each.value if isinstance(each, ast.Starred) else None
        yield from _spread(inside.elts) if isinstance(inside, ast.List | ast.Tuple) else (each,)


def _option_and_value(word: ast.expr | None) -> str:
    """Return the option that a text made of parts begins with, such as -x of `f"-x {x}"`; empty if it is none."""
    first = word.values[0] if isinstance(word, ast.JoinedStr) and word.values else None
    first = word.left if isinstance(word, ast.BinOp) and isinstance(word.op, ast.Add | ast.Mod) else first
    while isinstance(first, ast.BinOp):
        first = first.left
    said = text(first)
    return said.split()[0] if OPTION.match(said) and " " in said and "--ros-args" not in said else ""


def _joined(word: ast.expr | None) -> bool:
    """Whether an expression joins words of a command to one text, with spaces between them."""
    method = word.func if isinstance(word, ast.Call) else None
    if not isinstance(method, ast.Attribute) or method.attr != "join" or text(method.value) != " ":
        return False
    words = [each for part in word.args for each in walk(part)] if isinstance(word, ast.Call) else []
    return any(OPTION.match(text(each)) for each in words)


@launch_slip
def glued_parts(file: LaunchFile) -> Iterator[Place]:
    """Find options and a value in gz_args that are joined without a space."""
    for call in file.calls("IncludeLaunchDescription"):
        given = file.value(argument(call, "launch_arguments", 1))
        lists = [each for each in nodes_of(given, ast.List)] if given is not None else []
        for parts in lists:
            for one, other in zip(parts.elts, parts.elts[1:], strict=False):
                said = text(one)
                if said.startswith("-") and not said.endswith(" ") and not text(other).startswith((" ", "-")):
                    yield (
                        one.lineno,
                        f"a space is missing at the end of {said!r}: launch joins the parts of a list without spaces, "
                        "so the value after it becomes a part of the option",
                    )


def _of_processes(file: LaunchFile) -> Iterator[tuple[ast.Call, list[ast.expr]]]:
    for call in file.calls("ExecuteProcess", "ExecuteLocal", "Node"):
        name = "arguments" if last_name(call.func) == "Node" else "cmd"
        given = file.value(argument(call, name))
        if isinstance(given, ast.List):
            yield call, given.elts


@launch_slip
def simulator_arguments(file: LaunchFile) -> Iterator[Place]:
    """Find gz_sim.launch.py included without the one argument that it reads; it inherits those of its includer."""
    if any(text(each) == "gz_args" for each in file.nodes):
        return
    for call in file.calls("IncludeLaunchDescription"):
        parts = [file.value(each) if isinstance(each, ast.Name) else each for each in walk(call)]
        if not any("gz_sim.launch.py" in text(each) for part in parts if part for each in walk(part)):
            continue
        given = file.value(argument(call, "launch_arguments", 1))
        if given is None:
            yield call.lineno, "gz_sim.launch.py gets no gz_args here, so gz sim gets no world and no -r"
            continue
        keys = [text(key) for each in nodes_of(given, ast.Dict) for key in each.keys if key]
        if keys and all(keys):
            yield (
                given.lineno,
                f"gz_sim.launch.py has no argument called {keys[0]}: all that gz sim gets, world and -r too, is the "
                "text gz_args",
            )


@launch_slip
def parameters_on_the_command_line(file: LaunchFile) -> Iterator[Place]:
    """Find `name:=value` without the words that make it a parameter."""
    for call, words in _of_processes(file):
        if any(isinstance(word, ast.Starred) for word in words):
            continue  # the words of another list come in between
        said = [text(word) for word in words]
        for before, word in zip(["", *said], words, strict=False):
            value = text(word)
            if " " in value or not value.lstrip("_-").startswith(SIM_TIME):
                continue
            if value.replace(" ", "").lower() == f"{SIM_TIME}:=false":
                yield word.lineno, f"{value} turns simulated time off: the node keeps the time of the computer"
                continue
            if value.startswith(("_", "-")):
                yield word.lineno, f"{value} sets no parameter in ROS 2: the words are --ros-args -p {SIM_TIME}:=true"
                continue
            if last_name(call.func) == "Node" and "--ros-args" not in said and value.startswith(f"{SIM_TIME}:="):
                yield (
                    word.lineno,
                    f"{value!r} in the arguments of a Node is no parameter, because they come before --ros-args: "
                    f"parameters=[{{'{SIM_TIME}': True}}] is one",
                )
            elif before not in ("-p", "--param") and value.startswith(f"{SIM_TIME}:="):
                yield word.lineno, f"-p is missing before {value!r}: without it, this is no parameter"
            elif before in ("-p", "--param") and ":=" not in value:
                yield word.lineno, f"a parameter is written NAME:=VALUE, with := and no spaces: {SIM_TIME}:=true"


@launch_slip
def bridge_parameters(file: LaunchFile) -> Iterator[Place]:
    """Find a bridge that gets its configuration as a file of ROS parameters, or under another name."""
    for call in file.calls("Node"):
        if text(argument(call, "executable")) != "parameter_bridge":
            continue
        given = file.value(argument(call, "parameters"))
        arguments = argument(call, "arguments")
        if arguments is not None and "config_file" not in unparse(call):
            yield from _file_as_topic(file, arguments)
        elif arguments is not None and "--ros-args" not in unparse(file.value(arguments) or arguments):
            for each in walk(file.value(arguments) or arguments):
                if text(each).startswith("config_file:=") and isinstance(each, ast.Constant):
                    yield (
                        each.lineno,
                        "config_file:=... is no parameter among the arguments, which are topics: it is one in "
                        "parameters=[{'config_file': PATH}]",
                    )
        if not isinstance(given, ast.List):
            continue
        names = [text(key) for each in given.elts if isinstance(each, ast.Dict) for key in each.keys]
        files = [each for each in given.elts if not isinstance(file.value(each), ast.Dict)]
        if "config_file" in names or arguments is not None:
            continue
        if files and ".yaml" in unparse(file.value(files[0]) or files[0]):
            yield (
                files[0].lineno,
                "a path in the list of parameters is a file of ROS parameters; the bridge's file is the value of its "
                "parameter config_file: parameters=[{'config_file': PATH}]",
            )
        elif other := next((name for name in names if name and name not in (SIM_TIME, "lazy")), ""):
            yield (
                given.lineno,
                f"the bridge gets a parameter called {other}, which it does not know: its file is the value of "
                "config_file",
            )


def _file_as_topic(file: LaunchFile, arguments: ast.expr) -> Iterator[Place]:
    """Find the bridge's file among its arguments, which are topics."""
    given = file.value(arguments)
    for word in given.elts if isinstance(given, ast.List | ast.Tuple) else []:
        said = [text(each) for part in file.parts(word) for each in walk(part)]
        if any(each.endswith((".yaml", ".yml")) for each in said) and not any(":=" in each for each in said):
            yield (
                word.lineno,
                "the arguments of parameter_bridge are topics; its file is the value of its parameter config_file: "
                "parameters=[{'config_file': PATH}]",
            )


@launch_slip
def sim_time_for_others(file: LaunchFile) -> Iterator[Place]:
    """Find a SetParameter that is to reach a program which no Node starts."""
    programs = []
    for call in file.calls("ExecuteProcess"):
        words = texts_of(file, call)
        mentioned = None in command_words(file, call) or any(
            SIM_TIME in word or word == "--params-file" for word in words
        )
        if any(word.endswith(".py") for word in words) and not mentioned:
            programs.append(call)
    for call in file.calls("SetParameter", "SetUseSimTime"):
        if programs:
            yield (
                call.lineno,
                f"{last_name(call.func)} reaches only the Node actions after it; the ExecuteProcess in line "
                f"{programs[0].lineno} gets no parameters but those in its own command",
            )


@launch_slip
def arguments_for_nobody(file: LaunchFile) -> Iterator[Place]:
    """Find use_sim_time declared as an argument of the launch that nothing reads."""
    declared = [call for call in file.calls("DeclareLaunchArgument") if text(argument(call, "name", 0)) == SIM_TIME]
    said = [each for each in file.nodes if SIM_TIME in text(each)]
    inherited = any(file.calls("IncludeLaunchDescription"))
    for call in declared if len(said) == len(declared) and not inherited else ():
        yield (
            call.lineno,
            f"the argument {SIM_TIME} is declared, but nothing reads it: an argument of the launch reaches a node only "
            "where LaunchConfiguration passes it",
        )


@launch_slip
def detached(file: LaunchFile) -> Iterator[Place]:
    """Find a program that is started where Ctrl-C does not reach it."""
    for call in file.calls("ExecuteProcess", "ExecuteLocal", "Node"):
        given = file.value(argument(call, "cmd")), argument(call, "prefix"), argument(call, "arguments")
        for node in (each for part in given if part is not None for each in walk(part)):
            for word in text(node).split():
                if word in DETACH and isinstance(node, ast.Constant):
                    yield (
                        node.lineno,
                        f"{word} takes the program away from the launch, so that Ctrl-C does not reach it: the actions "
                        "of a launch run beside each other without that",
                    )


@launch_slip
def parameters_in_the_environment(file: LaunchFile) -> Iterator[Place]:
    """Find use_sim_time as an environment variable, or as an argument that a program's own code would have to read."""
    for call in file.calls("ExecuteProcess", "ExecuteLocal", "Node", "SetEnvironmentVariable"):
        own = last_name(call.func) == "SetEnvironmentVariable"
        given = [argument(call, "env"), argument(call, "additional_env"), argument(call, "name", 0) if own else None]
        for part in given:
            if part is not None and any(text(each).lower() == SIM_TIME for each in walk(file.value(part) or part)):
                yield (
                    part.lineno,
                    f"{SIM_TIME} is a parameter of a node, and no environment variable: the words of its command are "
                    f"--ros-args -p {SIM_TIME}:=true",
                )


@launch_slip
def files_as_topics(file: LaunchFile) -> Iterator[Place]:
    """Find the bridge's file among the words behind `ros2 run ros_gz_bridge parameter_bridge`."""
    for call in file.calls("ExecuteProcess", "ExecuteLocal"):
        given = argument(call, "cmd", 0)
        if given is not None and "parameter_bridge" in unparse(call) and "config_file" not in unparse(call):
            yield from _file_as_topic(file, given)


@launch_slip
def variables_of_the_shell(file: LaunchFile) -> Iterator[Place]:
    """Find `$world` in a command, where `world` is an argument of the launch."""
    names = {text(argument(call, "name", 0)) for call in file.calls("DeclareLaunchArgument")} - {""}
    for call in file.calls("ExecuteProcess", "ExecuteLocal"):
        given = argument(call, "cmd", 0)
        for node in walk(given) if given is not None else ():
            for name in re.findall(r"\$\{?(\w+)", text(node)):
                if name in names and isinstance(node, ast.Constant):
                    yield (
                        node.lineno,
                        f"${name} is a variable of a shell, which knows no arguments of the launch: the value is "
                        f"LaunchConfiguration('{name}'), an item of the list",
                    )


@launch_slip
def parameters_for_what_follows(file: LaunchFile) -> Iterator[Place]:
    """Find a SetParameter that stands behind all nodes which it could be meant for."""
    for call in file.calls("LaunchDescription"):
        given = file.value(argument(call, "initial_entities", 0))
        actions = [file.value(each) for each in given.elts] if isinstance(given, ast.List) else []
        kinds = [last_name(each.func) if isinstance(each, ast.Call) else "?" for each in actions]
        for place, (kind, action) in enumerate(zip(kinds, actions, strict=True)):
            behind = "Node" in kinds[:place] and not set(kinds[place:]) & STARTS_NODES
            if kind in ("SetParameter", "SetUseSimTime", "SetRemap", "PushRosNamespace") and behind and action:
                yield (
                    action.lineno,
                    f"{kind} reaches only the actions after it in the list, and all nodes come before it",
                )
