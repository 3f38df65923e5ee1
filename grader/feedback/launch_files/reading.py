"""A launch file in Python as the looks of this room read it: its calls, and what its names stand for."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from functools import cached_property
from types import MappingProxyType

from gz_course.grader.feedback.facts.syntax import last_name, nodes_of, walk

Place = tuple[int, str]
PROCESSES = frozenset({"Node", "LifecycleNode", "ExecuteProcess", "ExecuteLocal", "IncludeLaunchDescription"})
ACTIONS = PROCESSES | {
    "ComposableNodeContainer", "DeclareLaunchArgument", "GroupAction", "OpaqueFunction", "RegisterEventHandler",
    "SetEnvironmentVariable", "SetLaunchConfiguration", "SetParameter", "SetUseSimTime", "TimerAction",
}  # fmt: skip


def argument(call: ast.Call, name: str, position: int | None = None) -> ast.expr | None:
    """Return what a call is given by this name, or at this position."""
    given = next((each.value for each in call.keywords if each.arg == name), None)
    if given is None and position is not None and len(call.args) > position:
        return call.args[position]
    return given


def text(node: ast.AST | None) -> str:
    """Return the value of a constant text; empty for anything else."""
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else ""


class LaunchFile:
    """The syntax tree and the text of a launch file, and the programs that come with it, by name."""

    def __init__(
        self, tree: ast.Module, content: bytes = b"", beside: Mapping[str, bytes] = MappingProxyType({})
    ) -> None:
        self.tree, self.content, self.beside = tree, content, beside
        self.nodes = list(walk(tree))

    def calls(self, *names: str) -> Iterator[ast.Call]:
        """Yield the calls of these classes or functions, in the order of the lines."""
        found = [each for each in self.nodes if isinstance(each, ast.Call) and last_name(each.func) in names]
        yield from sorted(found, key=lambda each: (each.lineno, each.col_offset))

    @cached_property
    def assigned(self) -> dict[str, list[ast.expr]]:
        """Every value that a name is given in the file; a name that is also bound in another way has no values."""
        found: dict[str, list[ast.expr]] = {}
        bound: set[str] = set()
        seen: set[int] = set()
        for node in self.nodes:
            if isinstance(node, ast.Assign):
                for target in node.targets:
                    for name, value in _pairs(target, node.value):
                        found.setdefault(name.id, []).append(value)
                        seen.add(id(name))
        for node in self.nodes:
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and id(node) not in seen:
                bound.add(node.id)
            elif isinstance(node, ast.arg):
                bound.add(node.arg)
        return {name: values for name, values in found.items() if name not in bound}

    @cached_property
    def owners(self) -> dict[int, ast.FunctionDef]:
        """The innermost function around each call, by the id of the call."""
        found: dict[int, ast.FunctionDef] = {}
        for node in self.nodes:  # outer functions come before inner ones
            if isinstance(node, ast.FunctionDef):
                found |= {id(each): node for each in nodes_of(node, ast.Call)}
        return found

    @cached_property
    def used(self) -> set[str]:
        """Names that are read anywhere."""
        return {each.id for each in self.nodes if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Load)}

    def value(self, node: ast.expr | None) -> ast.expr | None:
        """Return what an expression stands for: the only value of a name, else the expression itself."""
        if isinstance(node, ast.Name) and len(self.assigned.get(node.id, ())) == 1:
            return self.assigned[node.id][0]
        return node

    def parts(self, node: ast.expr) -> list[ast.expr]:
        """Return an expression, and all that the names in it stand for, one after another."""
        found, seen = [node], set[str]()
        for each in found:
            names = {part.id for part in nodes_of(each, ast.Name)} - seen
            seen |= names
            found += [value for name in sorted(names) for value in self.assigned.get(name, ())]
        return found

    def configuration(self, node: ast.AST) -> str:
        """Return the name of the launch configuration that an expression is; empty if it is none."""
        if isinstance(node, ast.Name):
            values = self.assigned.get(node.id, [])
            names = {self.configuration(each) for each in values if isinstance(each, ast.Call)}
            return names.pop() if len(names) == 1 and all(isinstance(each, ast.Call) for each in values) else ""
        if isinstance(node, ast.Call) and last_name(node.func) == "LaunchConfiguration":
            return text(argument(node, "variable_name", 0)) or "?"
        return ""

    def performed(self, node: ast.AST) -> str:
        """Return the name of the configuration whose text an expression is, by `perform(context)`; else nothing."""
        if isinstance(node, ast.Name):
            values = self.assigned.get(node.id, [])
            return self.performed(values[0]) if len(values) == 1 and not isinstance(values[0], ast.Name) else ""
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "perform":
            return self.configuration(node.func.value)
        if isinstance(node, ast.Subscript) and last_name(node.value) == "launch_configurations":
            return text(node.slice)
        return ""


def _pairs(target: ast.expr, value: ast.expr) -> Iterator[tuple[ast.Name, ast.expr]]:
    if isinstance(target, ast.Name):
        yield target, value
    elif isinstance(target, ast.Tuple | ast.List) and isinstance(value, ast.Tuple | ast.List):
        for one, other in zip(target.elts, value.elts, strict=False):
            yield from _pairs(one, other)
