"""ROS parameters that a program does not get as they were meant: without --ros-args, undeclared, apart, or nested.

A remapping, -r FROM:=TO, works without it in its old form; a parameter does not.

Source: https://github.com/ros2/rcl, rcl/src/rcl/arguments.c
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from itertools import pairwise

from gz_course.grader.feedback.facts.syntax import last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.launch_files import launch_slip
from gz_course.grader.feedback.launch_files.reading import LaunchFile, Place, argument, text
from gz_course.grader.feedback.launch_files.unread import OF_EVERY_NODE, declared_parameters

PARAMETER = ("-p", "--param")
RULE = ("-r", "--remap")
QUOTED = re.compile(r"(\w+):=(['\"])([Tt]rue|[Ff]alse)\2")
OF_A_NODE = re.compile(r"(?:\s*#.*\n|\s*\n)*/?(\w+):\s*\n\s+ros__parameters:")
GROWS = ("append", "extend", "insert")
DEEPEST = 5  # lists in lists that are followed


@launch_slip
def without_ros_args(file: LaunchFile) -> Iterator[Place]:
    """Find `-p NAME:=VALUE` or `-r OLD:=NEW` in a command whose words are all known, none of them --ros-args."""
    for words in _commands(file):
        if None in words or any("--ros-args" in text(each) for word in words if word for each in walk(word)):
            continue
        for before, word in pairwise(word for word in words if word is not None):
            said = "".join(text(each) for each in walk(word))
            if text(before) in PARAMETER + RULE and ":=" in said:
                option = f"{text(before)} {said if text(word) else unparse(word)}"
                yield (
                    word.lineno,
                    f"--ros-args is missing before {option}: words before it "
                    "belong to the program, and ROS does not read them",
                )
                break


@launch_slip
def before_ros_args(file: LaunchFile) -> Iterator[Place]:
    """Find `-p NAME:=VALUE` or `-r OLD:=NEW` in front of the `--ros-args` of the same command, or behind its `--`."""
    for words in _commands(file):
        marks = [number for number, word in enumerate(words) if word is not None and text(word) == "--ros-args"]
        if len(marks) != 1:
            continue
        ends = (n for n, word in enumerate(words) if n > marks[0] and word is not None and text(word) == "--")
        end = next(ends, len(words))
        for number, (before, word) in enumerate(pairwise(words)):
            if marks[0] < number < end or before is None or word is None or text(before) not in PARAMETER + RULE:
                continue
            said = "".join(text(each) for each in walk(word))
            if ":=" not in said:
                continue
            option = f"{text(before)} {said if text(word) else unparse(word)}"
            which = "before --ros-args" if number < marks[0] else "behind the -- that ends the words after --ros-args"
            yield (
                word.lineno,
                f"{option} stands {which}, where it belongs to the program and ROS does not read it: --ros-args comes "
                "first, then each -p and -r",
            )
            break


@launch_slip
def values_apart(file: LaunchFile) -> Iterator[Place]:
    """Find `"-p", "NAME:=", VALUE` in a command, where the value is a word of its own."""
    for call in file.calls("ExecuteProcess", "ExecuteLocal", "Node"):
        for given in (argument(call, "cmd", 0), argument(call, "arguments")):
            words = file.value(given)
            for word, value in pairwise(words.elts) if isinstance(words, ast.List) else ():
                if (said := text(word)).endswith(":="):
                    yield (
                        word.lineno,
                        f"{said!r} and its value are two words here, and must be one: a list inside of the list joins "
                        f"them, [{said!r}, {unparse(value)[:60]}]",
                    )


@launch_slip
def nested_parameters(file: LaunchFile) -> Iterator[Place]:
    """Find a dict of parameters with the levels of a parameter file, which makes other names of them."""
    for call in file.calls("Node", "LifecycleNode"):
        given = argument(call, "parameters")
        for part in file.parts(given) if given is not None else ():
            for table in nodes_of(part, ast.Dict):
                if any(key is not None and text(key) == "ros__parameters" for key in table.keys):
                    yield (
                        table.lineno,
                        "ros__parameters and the name of the node belong into a parameter file; a dict in parameters "
                        "has the parameters themselves, such as {'use_sim_time': True}, and takes all else as part of "
                        "their names",
                    )


@launch_slip
def quoted_truths(file: LaunchFile) -> Iterator[Place]:
    """Find `{"use_sim_time": "True"}` in the parameters of a node: it takes True, and no text."""
    for call in file.calls("Node", "LifecycleNode"):
        given = argument(call, "parameters")
        for part in file.parts(given) if given is not None else ():
            for table in nodes_of(part, ast.Dict):
                for key, value in zip(table.keys, table.values, strict=True):
                    if key is not None and text(key) == "use_sim_time" and text(value):
                        yield (
                            value.lineno,
                            f"use_sim_time is given as the text {text(value)!r}, and takes True or False, without "
                            "quotes",
                        )


@launch_slip
def quotes_in_words(file: LaunchFile) -> Iterator[Place]:
    """Find `"use_sim_time:='true'"` in a list of words: no shell takes the quotes away."""
    for call in file.calls("ExecuteProcess", "ExecuteLocal", "Node"):
        if argument(call, "shell") is not None:
            return
    for node in file.nodes:
        if match := QUOTED.fullmatch(text(node)):
            yield (
                node.lineno,  # type: ignore[attr-defined]
                f"`{match[0]}` sets a text, and {match[1]} is true or false: no shell takes the quotes away here, so "
                f"write {match[1]}:={match[3].lower()}",
            )


@launch_slip
def undeclared(file: LaunchFile) -> Iterator[Place]:
    """Find `-p NAME:=VALUE` for a program of the submission that declares parameters of other names only."""
    for call in file.calls("ExecuteProcess", "ExecuteLocal"):
        words = command_words(file, call)
        names = {text(each).rpartition("/")[2] for word in words if word for each in walk(word)}
        program = next(iter(sorted(names & file.beside.keys())), "")
        known = declared_parameters(file.beside[program]) if program else set()
        for before, word in pairwise(words) if known else ():
            if before is None or word is None or text(before) not in PARAMETER:
                continue
            first = word.values[0] if isinstance(word, ast.JoinedStr) and word.values else word
            while isinstance(first, ast.BinOp):
                first = first.left
            name, assigns, _ = text(first).partition(":=")
            if assigns and name not in known | OF_EVERY_NODE and name.isidentifier():
                yield (
                    word.lineno,
                    f"{program} declares no parameter {name}, so nothing reads this one; it declares "
                    f"{', '.join(sorted(known))}",
                )


def _commands(file: LaunchFile) -> Iterator[list[ast.expr | None]]:
    """Yield the words of each command, and the arguments of each node; launch adds its --ros-args behind those."""
    for call in file.calls("ExecuteProcess", "ExecuteLocal", "Node", "LifecycleNode"):
        if words := command_words(file, call):
            yield words


def command_words(file: LaunchFile, call: ast.Call) -> list[ast.expr | None]:
    """Return the words of a command, or the arguments of a node, in their order; None for each that is not known."""
    given = argument(call, "arguments") if last_name(call.func).endswith("Node") else argument(call, "cmd", 0)
    if given is None:
        return []
    return list(_words(file, given, file.owners.get(id(call), file.tree), DEEPEST))


@launch_slip
def files_without_namespace(file: LaunchFile) -> Iterator[Place]:
    """Find a parameter file for a node `follower` in a command that puts the node into a namespace."""
    for words in _commands(file):
        said = {text(each) for word in words if word is not None for each in walk(word)} - {""}
        if "--params-file" not in said or not any("__ns:=" in each for each in said):
            continue
        line = next(word.lineno for word in words if word is not None)
        for name in sorted({each.rpartition("/")[2] for each in said} & file.beside.keys()):
            owner = OF_A_NODE.match(file.beside[name].decode(errors="replace"))
            if owner:
                yield (
                    line,
                    f"{name} holds parameters of the node /{owner[1]}, and this command puts its node into a "
                    f"namespace (__ns), so it is another node and reads none of them: begin the file with /**: instead "
                    f"of {owner[1]}:, which means every node",
                )


def _words(file: LaunchFile, given: ast.expr, scope: ast.AST, depth: int) -> Iterator[ast.expr | None]:
    """Yield the words of a command, in the order in which the file puts them together; None for what is not known."""
    if isinstance(given, ast.List | ast.Tuple):
        for each in given.elts:
            yield from _words(file, each.value, scope, depth - 1) if isinstance(each, ast.Starred) else (each,)
    elif isinstance(given, ast.BinOp) and isinstance(given.op, ast.Add):
        yield from _words(file, given.left, scope, depth - 1)
        yield from _words(file, given.right, scope, depth - 1)
    elif isinstance(given, ast.Name) and depth > 0 and (parts := _parts(file, given.id, scope)):
        for part in parts:
            yield from _words(file, part, scope, depth - 1)
    else:
        yield None


def _parts(file: LaunchFile, name: str, scope: ast.AST) -> list[ast.expr]:
    """Return the lists that a function puts together under a name, or that the file assigns once; else nothing."""
    found: list[tuple[int, ast.expr]] = []
    grows = [(name, method) for method in GROWS]
    for node in walk(scope) if scope is not file.tree else ():
        if isinstance(node, ast.Assign | ast.AugAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            if name in [unparse(target) for target in targets]:
                found.append((node.lineno, node.value))
        elif isinstance(node, ast.Call) and unparse(node.func).rpartition(".")[::2] in grows and node.args:
            extends = unparse(node.func).endswith(".extend")
            found.append((node.lineno, node.args[0] if extends else ast.List(node.args[-1:], ast.Load())))
    if found:
        return [value for _, value in sorted(found, key=lambda each: each[0])]
    return file.assigned.get(name, [])[:1] if len(file.assigned.get(name, [])) == 1 else []
