"""What makes the rhythm of a topic in a Python file: the period of a timer, or a condition for each message.

Right programs have both. The check of a rate names them if the messages came in that rhythm.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import (
    Places,
    assigned,
    calls,
    functions,
    parents,
    places_in,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips.nodes.scan_callbacks import callbacks

LEAVES = ast.Return | ast.Continue
MOST = 8  # places reported at most
DEEPEST = 3  # calls of functions of the file between a callback and publish()
Path = list[tuple[ast.Call, list[tuple[ast.If, bool]]]]  # a call, and the conditions before it, from within


def rhythm(content: bytes) -> Places:
    """Return places with `line`, `topic` and `said`, the words of a sentence; one of a timer has its `period` [s]."""
    return places_in(content, lambda tree: [*_on_a_condition(tree), *_periods(tree)][:MOST])


def _on_a_condition(tree: ast.AST) -> Iterator[dict[str, Any]]:
    """Find a topic on which every publish() stands behind a condition that is no start."""
    program = _Program(tree)
    for topic, sites in program.sites.items():
        paths = [path for site in sites for path in program.paths(site, DEEPEST)]
        if not paths or not all(any(tests for _, tests in path) for path in paths):
            continue
        ways = {(id(test), holds) for path in paths for _, tests in path for test, holds in tests}
        if any((test, not holds) in ways for test, holds in ways):
            continue  # one of two branches publishes in any case
        call, (test, holds) = next((call, tests[0]) for call, tests in paths[0] if tests)
        words = "holds" if holds else "does not hold"
        said = f"{unparse(call.func)}() is called only while `{unparse(test.test)[:70]}` {words}"
        yield {"line": call.lineno, "topic": topic, "said": f"{said} (line {test.lineno})"}


def _periods(tree: ast.Module) -> Iterator[dict[str, Any]]:
    """Find the timers that publish on a topic."""
    program, known = _Program(tree), named_numbers(tree)
    timers = [call for call, name in calls(tree) if name in ("create_timer", "create_wall_timer")]
    for topic, sites in program.sites.items():
        makers = {
            owner.name
            for site in sites
            for path in program.paths(site, DEEPEST)
            if (owner := program.owner.get(path[-1][0])) is not None
        }
        for call in timers:
            period = number(call.args[0], known) if len(call.args) > 1 else None
            if period and unparse(call.args[1]).rpartition(".")[2] in makers:
                said = f"{unparse(call)[:70]} publishes once in {period:g} s"
                yield {"line": call.lineno, "topic": topic, "said": said, "period": period}


class _Program:
    """The calls of publish() of a file by topic, and what leads to each."""

    def __init__(self, tree: ast.AST) -> None:
        self.callbacks = callbacks(tree)
        self.parent = parents(tree)
        self.set_back = {
            unparse(target)
            for function in functions(tree)
            if function.name != "__init__"
            for target, value in assigned(function)
            if unparse(value) in ("None", "False", "[]", "{}", "deque()", "0")
        }
        self.owner: dict[ast.AST, ast.FunctionDef] = {}
        for function in functions(tree):
            self.owner |= {node: function for node in walk(function) if node is not function}
        self.calls = list(calls(tree))
        publishers = {
            unparse(target): f"/{str(value.args[1].value).lstrip('/')}"
            for target, value in assigned(tree)
            if isinstance(value, ast.Call)
            and unparse(value.func).endswith("create_publisher")
            and len(value.args) > 1
            and isinstance(value.args[1], ast.Constant)
        }
        self.sites: dict[str, list[ast.Call]] = {}
        for call, name in self.calls:
            topic = publishers.get(unparse(call.func).rpartition(".")[0]) if name == "publish" else None
            if topic:
                self.sites.setdefault(topic, []).append(call)

    def paths(self, call: ast.Call, deepest: int) -> Iterator[Path]:
        """Yield the ways from callbacks to a call, from the call on; none if a callback is not found."""
        function = self.owner.get(call)
        if function is None:
            return
        own = (call, list(self._tests(call, function)))
        if function.name in self.callbacks:
            yield [own]
        for caller, name in self.calls if deepest else ():
            if name == function.name and self.owner.get(caller) is not function:
                yield from ([own, *rest] for rest in self.paths(caller, deepest - 1))

    def _tests(self, node: ast.AST, function: ast.FunctionDef) -> Iterator[tuple[ast.If, bool]]:
        """Yield the conditions before a node in its function and whether each holds, without those of a start."""
        while node is not function:
            above = self.parent[node]
            if isinstance(above, ast.If) and node is not above.test and not self._of_a_start(above.test):
                yield above, node in above.body
            for name in ("body", "orelse"):
                block = getattr(above, name, None)
                for before in reversed(block[: block.index(node)]) if isinstance(block, list) and node in block else ():
                    for each in walk(before) if isinstance(before, ast.If) else ():
                        leaves = isinstance(each, ast.If) and isinstance(each.body[-1], LEAVES)
                        if leaves and isinstance(each, ast.If) and not self._of_a_start(each.test):
                            yield each, False
            node = above

    def _of_a_start(self, test: ast.expr) -> bool:
        """Return whether a condition asks whether something has come at all: `self.pose is None`, `not self.poses`."""
        match test:
            case ast.BoolOp():
                return all(self._of_a_start(each) for each in test.values)
            case ast.UnaryOp(op=ast.Not(), operand=kept) | ast.Compare(left=kept, comparators=[ast.Constant(None)]):
                return unparse(kept) not in self.set_back
        return isinstance(test, ast.Name | ast.Attribute) and unparse(test) not in self.set_back
