"""What a launch file declares or names and nobody reads: arguments, braces in a text, parameters of its nodes."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import calls, last_name, parsed, unparse, walk
from gz_course.grader.feedback.launch_files import launch_slip
from gz_course.grader.feedback.launch_files.reading import LaunchFile, Place, argument, text
from gz_course.sim.did_you_mean import nearest_name

IN_A_TEXT = re.compile(r"\$\(var (\w+)\)")
BRACES = re.compile(r"\{([A-Za-z_]\w*)(?:[^{}]*)\}")
# Arguments of gz_sim.launch.py, which an included launch file reads.
INCLUDED = frozenset({"gz_args", "gz_version", "ign_args", "ign_version", "debugger", "on_exit_shutdown"})
OF_EVERY_NODE = frozenset({"use_sim_time", "start_type_description_service"})


@launch_slip
def arguments_unread(file: LaunchFile) -> Iterator[Place]:
    """Find an argument that is declared, and whose value nothing asks for in a file that asks for that of another."""
    read, unknown = set[str](), False
    for node in file.nodes:
        if isinstance(node, ast.Call) and last_name(node.func).startswith("LaunchConfiguration"):
            name = text(file.value(argument(node, "variable_name", 0)))
            read.add(name)
            unknown = unknown or not name
        elif isinstance(node, ast.Attribute) and node.attr == "launch_configurations":
            read |= {text(each) for each in file.nodes}
        elif text(node):
            read |= set(IN_A_TEXT.findall(text(node)))
    includes = any(file.calls("IncludeLaunchDescription"))
    for call in file.calls("DeclareLaunchArgument"):
        name = text(argument(call, "name", 0))
        if read - {""} and name and name not in read and not unknown and not (includes and name in INCLUDED):
            yield (
                call.lineno,
                f"the argument {name} is declared, and nothing in this file asks for its value, "
                f"LaunchConfiguration('{name}'): {name}:=... changes nothing",
            )


@launch_slip
def braces_without_f(file: LaunchFile) -> Iterator[Place]:
    """Find a text such as "/robot{number}" with the name of a variable in braces, and no f before its quotes."""
    inside = {id(part) for node in file.nodes if isinstance(node, ast.JoinedStr) for part in node.values}
    formatted = {id(n.func.value) for n in file.nodes if isinstance(n, ast.Call) and isinstance(n.func, ast.Attribute)}
    names = {each.id for each in file.nodes if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store)}
    names |= {each.arg for each in file.nodes if isinstance(each, ast.arg)}
    for node in file.nodes:
        if id(node) in inside | formatted or not isinstance(node, ast.Constant):
            continue
        match = BRACES.search(text(node))
        if match and match[1] in names:
            yield (
                node.lineno,
                f"{text(node)[:60]!r} has no f before its quotes, so {match[0]} is not replaced: write f'...'",
            )


@launch_slip
def undeclared_parameters(file: LaunchFile) -> Iterator[Place]:
    """Find a parameter that the launch file gives a node of the submission, which declares others only."""
    for call in file.calls("Node", "ExecuteProcess"):
        words = {text(each).rpartition("/")[2] for part in (*call.args, *call.keywords) for each in walk(part)}
        for part in (file.value(each.value) for each in call.keywords):
            words |= {text(each).rpartition("/")[2] for each in walk(part)} if part is not None else set()
        program = next(iter(sorted(words & file.beside.keys())), "")
        known = declared_parameters(file.beside[program]) if program else set()
        for name, line in _given(file, call):
            if _near_sim_time(name) and name.encode() not in file.beside.get(program, b""):
                yield line, f"no node has a parameter {name}: the one that turns simulated time on is use_sim_time"
        for name, line in _given(file, call) if known else ():
            if name not in known | OF_EVERY_NODE and not _near_sim_time(name):
                yield (
                    line,
                    f"{program} declares no parameter {name}, so nothing reads this one; it declares "
                    f"{', '.join(sorted(known))}",
                )


@launch_slip
def for_another_program(file: LaunchFile) -> Iterator[Place]:
    """Find a parameter that is given to one program of the submission, and declared by another one only."""
    declared = {name: declared_parameters(content) for name, content in file.beside.items()}
    for call in file.calls("Node"):
        words = {text(each).rpartition("/")[2] for part in file.parts(call) for each in walk(part)}
        program = next(iter(sorted(words & file.beside.keys())), "")
        if not program or b"parameter" in file.beside[program]:
            continue
        for name, line in _given(file, call):
            others = [other for other, names in sorted(declared.items()) if name in names]
            if len(others) == 1:
                yield (
                    line,
                    f"the parameter {name} is given to {program} here, which declares none; {others[0]} declares it, "
                    "so it belongs to the action that starts that",
                )


def _near_sim_time(name: str) -> bool:
    """Return whether a name is nearly use_sim_time, and another one."""
    return name != "use_sim_time" and bool(nearest_name(name.lower(), ["use_sim_time"], 0.75))


def declared_parameters(content: bytes) -> set[str]:
    """Return the parameters that a program declares; none if that is not known."""
    tree = parsed(content)
    found = [(call, name) for call, name in calls(tree) if name.startswith("declare_parameter")]
    names = {text(argument(call, "name", 0)) for call, _ in found}
    if "" in names or any(name == "declare_parameters" for _, name in found):
        return set()
    return set() if "undeclared_parameters" in unparse(tree) else names


def _given(file: LaunchFile, call: ast.Call) -> Iterator[tuple[str, int]]:
    """Yield the names of the parameters that an action gives, with their lines."""
    given = file.value(argument(call, "parameters"))
    for each in given.elts if isinstance(given, ast.List | ast.Tuple) else ():
        table = file.value(each)
        if isinstance(table, ast.Dict):
            yield from ((text(key), key.lineno) for key in table.keys if key is not None and text(key))
