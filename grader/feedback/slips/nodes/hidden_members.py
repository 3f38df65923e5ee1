"""Members of a node's class that hide those of rclpy's `Node`, which rclpy itself goes on using.

Source: rclpy 7.1 (ROS 2 Jazzy), `rclpy.node.Node`: its properties, and the methods that it or an executor calls.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, last_name, nodes_of, walk
from gz_course.grader.feedback.slips import slip

NODES = {"Node", "LifecycleNode"}
# Properties that rclpy reads.
READ = {
    "clients",
    "context",
    "default_callback_group",
    "executor",
    "guards",
    "handle",
    "publishers",
    "services",
    "subscriptions",
    "timers",
    "waitables",
}
# Methods of which rclpy uses the result.
ASKED = {"get_clock", "get_logger", "get_name", "get_namespace", "get_parameter", "has_parameter", "create_service"}


@slip
def hidden_members(tree: ast.AST) -> Iterator[Place]:
    """Find a method or an attribute of a node's class under the name of one that rclpy needs."""
    nodes = set(NODES)
    for each in nodes_of(tree, ast.ClassDef):
        if not any(last_name(base) in nodes for base in each.bases):
            continue
        nodes.add(each.name)
        for name, member in _members(each):
            if name in READ and not _is_property(member):
                yield (
                    member.lineno,
                    f"{each.name}.{name} hides the {name} of Node, which rclpy itself reads: give it another name",
                )
            elif name in ASKED and isinstance(member, ast.FunctionDef) and not _returns(member):
                yield (
                    member.lineno,
                    f"{each.name}.{name}() hides {name}() of Node, which rclpy itself calls, and returns nothing: give "
                    "it another name",
                )


def _members(owner: ast.ClassDef) -> Iterator[tuple[str, ast.stmt]]:
    for each in owner.body:
        if isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef):
            yield each.name, each
        elif isinstance(each, ast.Assign):
            yield from ((target.id, each) for target in each.targets if isinstance(target, ast.Name))
        elif isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name) and each.value is not None:
            yield each.target.id, each


def _is_property(member: ast.stmt) -> bool:
    return isinstance(member, ast.FunctionDef) and bool(member.decorator_list)


def _returns(function: ast.FunctionDef) -> bool:
    return any(isinstance(each, ast.Return) and each.value is not None for each in walk(function))
