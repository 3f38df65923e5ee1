"""What a launch file states, for checks that ask: arguments, remappings, programs, counts, simulators."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from gz_course.grader.feedback.facts.syntax import functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.launch_files import launch_fact
from gz_course.grader.feedback.launch_files.actions import MAIN, endless
from gz_course.grader.feedback.launch_files.reading import PROCESSES, LaunchFile, argument, text
from gz_course.grader.feedback.launch_files.ros_arguments import command_words

STARTS = ("ExecuteProcess", "ExecuteLocal", "Node", "IncludeLaunchDescription")
GROUPS = ("GroupAction", "TimerAction", "RegisterEventHandler")
SIMULATORS = ("gz sim", "gz_sim.launch.py")
DECIDES = ast.If | ast.IfExp | ast.For | ast.ListComp | ast.Lambda
ROUND = ("enumerate", "list", "tuple", "sorted", "reversed", "items", "keys", "values")
SIM_TIME = "use_sim_time"


@launch_fact("simulators_made")
def simulators(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield `line` and `condition` (its code, or empty) of each action that starts a simulator.

    Nothing is yielded for those that a function makes, or about which Python decides.
    """
    yield from _actions(file, SIMULATORS)


@launch_fact("bridges_made")
def bridges(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield the same of each action that starts a bridge."""
    yield from _actions(file, ("parameter_bridge",))


def _actions(file: LaunchFile, programs: tuple[str, ...]) -> Iterator[dict[str, Any]]:
    grouped: dict[int, str] = {}
    for group in file.calls(*GROUPS):
        if condition := argument(group, "condition"):
            grouped |= {id(each): unparse(condition) for part in file.parts(group) for each in walk(part)}
    decided = {
        id(each)
        for node in file.nodes
        if isinstance(node, DECIDES) or (isinstance(node, ast.FunctionDef) and node.name != MAIN)
        for each in walk(node)
    }
    for call in file.calls(*STARTS):
        if endless(call) in programs and id(call) not in decided:
            condition = argument(call, "condition")
            yield {"line": call.lineno, "condition": unparse(condition) if condition else grouped.get(id(call), "")}


@launch_fact("fixed_counts")
def fixed_counts(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield `line`, `count` and `said` (what ends there) of each loop that makes so many actions at most.

    Actions of `create` that the file holds one by one are counted, too.
    """
    makers = {f.name for f in functions(file.tree) if any(_starts(each) for each in walk(f))}
    loops = [node for node in file.nodes if isinstance(node, ast.For | ast.ListComp | ast.GeneratorExp)]
    inside = set[int]()
    for loop in loops:
        parts = loop.body if isinstance(loop, ast.For) else [loop.elt]
        calls = [each for part in parts for each in nodes_of(part, ast.Call)]
        inside |= {id(each) for each in calls}
        if not any(_starts(each) or last_name(each.func) in makers for each in calls):
            continue
        for over in [loop.iter] if isinstance(loop, ast.For) else [each.iter for each in loop.generators]:
            if found := _length(file, over):
                count, place = found
                yield {"line": place.lineno, "count": count, "said": f"{_shown(over)} ends at {count}"}
    for call in file.calls("min"):
        numbers = [each.value for each in call.args if isinstance(each, ast.Constant) and isinstance(each.value, int)]
        if len(call.args) == 2 and numbers and "robots" in unparse(call):
            said = f"{unparse(call)[:60]} is never more than {numbers[0]}"
            yield {"line": call.lineno, "count": numbers[0], "said": said}
    made = [call for call in file.calls("Node") if text(argument(call, "executable", 0)) == "create"]
    in_functions = {id(each) for f in functions(file.tree) if f.name in makers for each in walk(f)}
    written = [call for call in made if id(call) not in inside and (id(call) not in in_functions or len(made) > 1)]
    if len(written) > 1:
        said = f"the file holds {len(written)} actions of create, one by one"
        yield {"line": written[-1].lineno, "count": len(written), "said": said}


def _starts(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and last_name(node.func) in PROCESSES


def _shown(over: ast.expr) -> str:
    said = unparse(over)
    return said if len(said) <= 40 else "the list"


def _length(file: LaunchFile, over: ast.expr) -> tuple[int, ast.expr] | None:
    """Return how many items there are at most, and where that is written; None if the file does not say so."""
    over = file.value(over) or over
    if isinstance(over, ast.List | ast.Tuple | ast.Set) and not any(isinstance(e, ast.Starred) for e in over.elts):
        return len(over.elts), over
    if isinstance(over, ast.Dict) and None not in over.keys:
        return len(over.keys), over
    if isinstance(over, ast.Subscript) and isinstance(over.slice, ast.Slice):
        return _length(file, over.value)
    if not isinstance(over, ast.Call):
        return None
    name = last_name(over.func)
    if name == "range":
        ends = [file.value(each) for each in over.args]
        values = [each.value for each in ends if isinstance(each, ast.Constant) and isinstance(each.value, int)]
        return (len(range(*values)), over) if 0 < len(values) == len(over.args) <= 2 else None
    if name == "zip":
        lengths = [found for each in over.args if (found := _length(file, each))]
        return min(lengths, key=lambda each: each[0], default=None)
    if name in ROUND and (over.args or isinstance(over.func, ast.Attribute)):
        return _length(file, over.args[0] if over.args else over.func.value)  # type: ignore[attr-defined]
    return None


@launch_fact("declared", most=None)
def declared(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield `line`, `name` and `default`, a text or empty."""
    names = set()
    for call in file.calls("DeclareLaunchArgument"):
        name = text(argument(call, "name", 0))
        names.add(name)
        yield {"line": call.lineno, "name": name, "default": text(file.value(argument(call, "default_value")))}
    for call in file.calls("LaunchConfiguration"):
        name = text(argument(call, "variable_name", 0))
        if argument(call, "default") and name not in names:
            yield {"line": call.lineno, "name": name, "default": text(file.value(argument(call, "default")))}


@launch_fact("remappings")
def remappings(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield `line`, the `namespace` of the node (empty for the root), and the names `from` and `to`, as written.

    Rules among the words of a command, `-r FROM:=TO`, come after those in `remappings`.
    """
    for call in file.calls("Node", "LifecycleNode"):
        given = file.value(argument(call, "remappings"))
        space = text(file.value(argument(call, "namespace"))).strip("/")
        for pair in given.elts if isinstance(given, ast.List | ast.Tuple) else ():
            if isinstance(pair, ast.Tuple | ast.List) and len(pair.elts) == 2:
                old, new = (text(file.value(each)) for each in pair.elts)
                if old and new:
                    yield {"line": pair.lineno, "namespace": space, "from": old, "to": new}
    for call in file.calls("Node", "LifecycleNode", "ExecuteProcess"):
        words = file.value(argument(call, "arguments") or argument(call, "cmd", 0))
        said = [(each.lineno, text(each)) for each in words.elts] if isinstance(words, ast.List | ast.Tuple) else []
        rules = {line_and_word for option, line_and_word in pairwise(said) if option[1] in ("-r", "--remap")}
        spaces = [word.partition(":=")[2] for _, word in rules if word.startswith("__ns:=")]
        space = (spaces or [text(file.value(argument(call, "namespace")))])[0].strip("/")
        for line, word in sorted(rules):
            old, _, new = word.partition(":=")
            if old and new and not old.startswith("__"):
                yield {"line": line, "namespace": space, "from": old, "to": new}


@launch_fact("programs")
def programs(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield `line`, `program` (the name of its file) and `sim_time`, whether the action mentions it, of each program.

    `mentioned` is the same, and false where simulated time may come in a way that is not seen, as from a file.
    `elsewhere` is what another action of a node has it for: its line and executable; 0 and empty if none has.
    """
    others = [
        (call.lineno, text(file.value(argument(call, "executable", 0))))
        for call in file.calls("Node", "LifecycleNode")
        if SIM_TIME in texts_of(file, call) and not any(word.endswith(".py") for word in texts_of(file, call))
    ]
    line, executable = others[0] if others else (0, "")
    for call in file.calls("ExecuteProcess", "ExecuteLocal", "Node"):
        words = texts_of(file, call)
        for word in words:
            name = word.rpartition("/")[2]
            if name.endswith(".py") and " " not in name:
                mentioned = any(SIM_TIME in each for each in words)
                yield {
                    "line": call.lineno,
                    "program": name,
                    "sim_time": mentioned or any(_unknown(file, call)),
                    "mentioned": mentioned,
                    "elsewhere": line,
                    "executable": executable,
                }
                break


def texts_of(file: LaunchFile, call: ast.Call) -> set[str]:
    """Return all texts of an action, those that its names stand for too."""
    parts = [*file.parts(call), *(part for part in command_words(file, call) if part is not None)]
    return {text(each) for part in parts for each in walk(part)} - {""}


def _unknown(file: LaunchFile, call: ast.Call) -> Iterator[bool]:
    """Yield whether simulated time may come to an action in a way that is not seen in it.

    It may come from a SetParameter or a parameter file, for a node, and from words that a function returns.
    """
    if last_name(call.func) == "Node":
        given = file.value(argument(call, "parameters"))
        files = given.elts if isinstance(given, ast.List | ast.Tuple) else []
        yield any(not isinstance(file.value(each), ast.Dict) for each in files)
        yield any(file.calls("SetParameter", "SetUseSimTime", "SetParametersFromFile"))
    yield None in command_words(file, call) or "--params-file" in texts_of(file, call)
