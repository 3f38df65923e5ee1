"""Fields that a message does not have, in the call that makes it: `String(text="hello")`.

rclpy ignores such a word unless ROS_PYTHON_CHECK_FIELDS=1, and the message stays empty.
Source: the constructors that rosidl_generator_py writes.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import Run, slip_of_run
from gz_course.sim.did_you_mean import nearest_name


@slip_of_run
def unknown_fields(tree: ast.AST, run: Run) -> Iterator[Place]:
    others, modules = _other_owners(tree), _modules(tree)
    for node in nodes_of(tree, ast.Call):
        owner, _, kind = unparse(node.func).rpartition(".")
        foreign = not (owner.endswith(".msg") or owner in modules) if owner else kind in others
        known = [] if foreign else run.fields.get(kind, [])
        for word in node.keywords if known else ():
            if word.arg is None or word.arg in known:
                continue
            near = nearest_name(word.arg, known) or (known[0] if len(known) == 1 else "")
            there = f"it is called {near}" if near else f"it has {', '.join(known)}"
            yield (
                word.value.lineno,
                f"a {kind} has no field {word.arg}: {there}; {kind}({word.arg}=...) leaves the message as it is, "
                "without an error",
            )


def _other_owners(tree: ast.AST) -> set[str]:
    """Return the names that stand for something else than a message: rclpy's Time, pathlib's Path, an own Point."""
    found: set[str] = set()
    for node in walk(tree):
        if isinstance(node, ast.ImportFrom) and not (node.module or "").endswith((".msg", "_msgs", "_interfaces")):
            found |= {each.asname or each.name for each in node.names}
        elif isinstance(node, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            found.add(node.name)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            found.add(node.id)
        elif isinstance(node, ast.arg):
            found.add(node.arg)
    return found


def _modules(tree: ast.AST) -> set[str]:
    """Return the names under which a file knows whole modules of messages."""
    found = {"msg"}
    for node in nodes_of(tree, ast.Import, ast.ImportFrom):
        found |= {each.asname for each in node.names if each.asname and each.name.rpartition(".")[2] == "msg"}
    return found
