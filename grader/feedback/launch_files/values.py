"""Launch configurations that are read before they have a value, or whose text is taken for something else.

A launch configuration gets its value when the launch runs, not while `generate_launch_description()` makes the
description. Its value is a text.

Source: https://docs.ros.org/en/jazzy/Tutorials/Intermediate/Launch/Using-Substitutions.html
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from typing import Any

from gz_course.grader.feedback.facts.syntax import last_name, unparse, walk
from gz_course.grader.feedback.launch_files import MOST, launch_fact, launch_slip
from gz_course.grader.feedback.launch_files.reading import LaunchFile, Place, argument, text

BEFORE = ("actions", "conditional", "unread")


TRUTHS = frozenset({"True", "False"})
EQUALS = frozenset({"EqualsSubstitution", "NotEqualsSubstitution", "LaunchConfigurationEquals"})
PYTHON_TRUTH = re.compile(r"[=!]=\s*['\"]?(True|False)\b")
VALUE = "VALUE"  # what stands for the text of a configuration in an expression
TEXT_TRUTH = re.compile(rf"\b(?:if|not|and|or)\s+['\"]{VALUE}['\"]\s*(?:$|\)|\belse\b|\band\b|\bor\b)")
WORLD = re.compile(r"(?:^|[\s/])([\w-]+\.(?:sdf|world))$")


@launch_slip
def decided_too_early(file: LaunchFile) -> Iterator[Place]:
    """Find a configuration that is compared, or whose truth is asked for, by Python."""
    for node in file.nodes:
        if isinstance(node, ast.Compare):
            for side in (node.left, *node.comparators):
                if name := file.configuration(side):
                    yield (
                        node.lineno,
                        f"{_code(node)} is decided while the description is made: there, {_code(side)} is an object "
                        f"without a value, and equal to no text. {_instead(name)}",
                    )
                    break
        for tested in _tested(node):
            if name := file.configuration(tested):
                yield (
                    tested.lineno,
                    f"Python asks here whether {_code(tested)} is true, while the description is made: it is an object "
                    f"without a value there, which always counts as true. {_instead(name)}",
                )


def _tested(node: ast.AST) -> list[ast.expr]:
    """Return the expressions whose truth a node asks for."""
    if isinstance(node, ast.If | ast.IfExp | ast.While):
        return [node.test]
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        return [node.operand]
    if isinstance(node, ast.BoolOp):
        return node.values
    if isinstance(node, ast.Call) and last_name(node.func) == "bool" and isinstance(node.func, ast.Name):
        return node.args[:1]
    return []


def _instead(name: str) -> str:
    return (
        f"IfCondition(LaunchConfiguration('{name}')) and UnlessCondition decide when the launch runs; so does "
        "OpaqueFunction"
    )


def _code(node: ast.AST) -> str:
    return unparse(node)[:80]


@launch_slip
def written_into_text(file: LaunchFile) -> Iterator[Place]:
    """Find a configuration in an f-string, in str(), in format() or behind %."""
    for node in file.nodes:
        inside: list[ast.expr] = []
        if isinstance(node, ast.JoinedStr):
            inside = [each.value for each in node.values if isinstance(each, ast.FormattedValue)]
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("str", "repr"):
            inside = node.args[:1]
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and text(node.func.value):
            inside = node.args if node.func.attr == "format" else []
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mod) and text(node.left):
            inside = node.right.elts if isinstance(node.right, ast.Tuple) else [node.right]
        for each in inside:
            if file.configuration(each):
                yield (
                    each.lineno,
                    f"{_code(node)} puts a description of the object {_code(each)} into the text, not its value, which "
                    "is known only when the launch runs: pass the object itself, and where text and value belong "
                    "together, a list of both, such as ['text', value], which launch joins",
                )


@launch_slip
def texts_as_truths(file: LaunchFile) -> Iterator[Place]:
    """Find the text of a configuration that is asked for its truth: 'false' is a text that is not empty."""
    for node in file.nodes:
        for tested in _tested(node):
            if file.performed(tested):
                yield (
                    tested.lineno,
                    f"{_code(tested)} is a text, and every text that is not empty counts as true, 'false' as well: "
                    f"compare it, {_code(tested)} == 'true'",
                )


@launch_slip
def python_truths(file: LaunchFile) -> Iterator[Place]:
    """Find a text that is compared with True or 'True', while arguments are given as true and false."""
    for node in file.nodes:
        if isinstance(node, ast.Compare) and len(node.comparators) == 1:
            sides = (node.left, node.comparators[0])
            truths = [str(side.value) for side in sides if isinstance(side, ast.Constant)]
            if truths and truths[0] in TRUTHS and any(file.performed(side) for side in sides):
                yield node.lineno, f"{_code(node)}: {_small(truths[0])}"
        elif isinstance(node, ast.Call) and last_name(node.func) in EQUALS:
            if truths := [text(each) for each in node.args if text(each) in TRUTHS]:
                yield node.lineno, f"{_code(node)}: {_small(truths[0])}"
        elif isinstance(node, ast.Call) and last_name(node.func) == "PythonExpression":
            said = "".join(text(each) for each in walk(node))
            match = PYTHON_TRUTH.search(said)
            if match and not re.search(r"['\"](?:true|false)['\"]|lower|upper|capitalize|title", said):
                yield node.lineno, f"this expression compares with '{match[1]}': {_small(match[1])}"


@launch_slip
def expressions_of_truth(file: LaunchFile) -> Iterator[Place]:
    """Find a PythonExpression that asks whether a text is true: 'false' in quotes is true, too."""
    for call in file.calls("PythonExpression"):
        given = file.value(argument(call, "expression", 0))
        parts = given.elts if isinstance(given, ast.List | ast.Tuple) else []
        said = "".join(text(each) if isinstance(each, ast.Constant) else VALUE for each in parts)
        if TEXT_TRUTH.search(said):
            yield (
                call.lineno,
                "this expression asks whether a text in quotes is true, and every text that is not empty is, 'false' "
                "as well: compare it, [\"'\", value, \"' == 'true'\"]",
            )


def _small(truth: str) -> str:
    return f"the value of an argument is the text that was typed, '{truth.lower()}' in lower case, not '{truth}'"


@launch_slip
def words_of_the_command(file: LaunchFile) -> Iterator[Place]:
    """Find a launch file that reads the command line or the environment for its arguments."""
    for node in file.nodes:
        if isinstance(node, ast.Attribute) and node.attr == "argv" and last_name(node.value) == "sys":
            yield (
                node.lineno,
                "sys.argv is the command line of ros2 launch itself; the value of an argument is "
                "LaunchConfiguration('NAME')",
            )
        elif isinstance(node, ast.Call) and last_name(node.func) == "ArgumentParser":
            yield (
                node.lineno,
                "argparse reads the command line of ros2 launch itself; an argument of a launch file is declared with "
                "DeclareLaunchArgument",
            )


@launch_fact("fixed_worlds", most=MOST)
def fixed_worlds(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Find the names of worlds that stand as texts in a command or in `gz_args`, where an argument could decide."""
    for call in file.calls("ExecuteProcess", "Node", "IncludeLaunchDescription"):
        for given in (argument(call, "cmd", 0), argument(call, "arguments"), argument(call, "launch_arguments", 1)):
            for node in walk(given) if given is not None else ():
                part = file.value(node) if isinstance(node, ast.Name) else node
                if isinstance(part, ast.Constant) and (match := WORLD.search(text(part).strip())):
                    yield {"line": part.lineno, "world": match[1]}
