"""A lock that is taken again by the thread that holds it, and so waits for itself."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, assigned, calls, functions, last_name, nodes_of, unparse
from gz_course.grader.feedback.slips import slip


def _taken(function: ast.FunctionDef, locks: set[str]) -> Iterator[tuple[str, ast.With]]:
    for node in nodes_of(function, ast.With):
        for item in node.items:
            if (name := unparse(item.context_expr)) in locks:
                yield name, node


@slip
def taken_twice(tree: ast.AST) -> Iterator[Place]:
    """Find a function that is called while a Lock is held, and that takes the same Lock."""
    locks = {
        unparse(target)
        for target, value in assigned(tree)
        if isinstance(value, ast.Call) and last_name(value.func) == "Lock"
    }
    takers = {(function.name, name) for function in functions(tree) for name, _ in _taken(function, locks)}
    classes = [node for node in nodes_of(tree, ast.ClassDef)]
    methods = {function.name for owner in classes for function in owner.body if isinstance(function, ast.FunctionDef)}
    for function in functions(tree):
        for lock, held in _taken(function, locks):
            for part in held.body:
                for call, name in calls(part):
                    # A method is called by self.NAME(); a local variable may have the same name.
                    own = f"self.{name}" if name in methods else name
                    if unparse(call.func) == own and (name, lock) in takers:
                        yield (
                            call.lineno,
                            f"{unparse(call.func)}() takes {lock}, which line {held.lineno} holds already, so it "
                            "waits for ever: a Lock can be taken once only, an RLock again by the same thread",
                        )
                        return
