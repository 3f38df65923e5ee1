"""Edits of whole statements in a Python file that could mend it: deleted, moved, or one more."""

from __future__ import annotations

import ast
import itertools
import re
from collections.abc import Iterator

from gz_course.grader.edits.edit import Edit, Text

SIMPLE = (ast.Assign, ast.AugAssign, ast.AnnAssign, ast.Expr, ast.Return, ast.Continue, ast.Break, ast.Raise)
ENDS = re.compile(rb"\.cancel\(\)|shutdown\(|raise SystemExit|\breturn\b|\bbreak\b|destroy_")
PUBLISHER = re.compile(r"(\S+) = \S*create_publisher\((?:msg_type=)?(\w+),")
GOAL = "goal_handle"


def moved(text: Text, tree: ast.Module) -> list[Edit]:
    """Return the edits of a file's statements."""
    return list(_Statements(text, tree).edits())


class _Statements:
    def __init__(self, text: Text, tree: ast.Module) -> None:
        self._text = text
        self._tree = tree
        self._lines = text.content.split(b"\n")
        source = text.content.decode()
        self._stops = [f"{name}.publish({kind}())" for name, kind in PUBLISHER.findall(source) if "self." in name]

    def edits(self) -> Iterator[Edit]:
        for node in ast.walk(self._tree):
            if isinstance(node, ast.Module | ast.ClassDef):
                continue
            if isinstance(node, ast.FunctionDef):
                yield from self._in_function(node)
            for name in ("body", "orelse", "finalbody"):
                body = getattr(node, name, None)
                if isinstance(body, list) and body and isinstance(body[0], ast.stmt) and self._is_block(body):
                    yield from self._in_block(node, body)
            if isinstance(node, ast.If) and not node.orelse and self._is_block(node.body):
                yield from self._otherwise(node)

    def _is_block(self, body: list[ast.stmt]) -> bool:
        """Tell whether each statement begins a line of its own."""
        return all(not self._lines[each.lineno - 1][: each.col_offset].strip() for each in body)

    def _edit(self, operator: str, first: ast.stmt, last: ast.stmt, line: int, now: list[bytes]) -> Edit:
        """Return the edit in which the lines from one statement to another are replaced."""
        assert last.end_lineno is not None and last.end_col_offset is not None
        begin, end = self._text.at(first.lineno, 0), self._text.at(last.end_lineno, last.end_col_offset)
        return self._text.edit(operator, line, begin, end, b"\n".join(now).decode())

    def _of(self, statement: ast.stmt) -> list[bytes]:
        assert statement.end_lineno is not None
        return self._lines[statement.lineno - 1 : statement.end_lineno]

    def _in_block(self, node: ast.AST, body: list[ast.stmt]) -> Iterator[Edit]:
        for statement in body:
            own, indent = self._of(statement), b" " * statement.col_offset
            if isinstance(statement, SIMPLE) and not _is_docstring(statement) and b"create_publisher" not in own[0]:
                yield self._edit("deleted", statement, statement, statement.lineno, [indent + b"pass"])
            if ENDS.search(own[0]) and isinstance(statement, SIMPLE):
                for stop in self._stops:
                    now = [indent + stop.encode(), *own]
                    yield self._edit("command", statement, statement, statement.lineno, now)
        for first, second in itertools.pairwise(body):
            if isinstance(first, SIMPLE) and isinstance(second, SIMPLE) and not _is_docstring(first):
                now = [*self._of(second), *self._of(first)]
                yield self._edit("order", first, second, second.lineno, now)
            if isinstance(first, ast.If | ast.For | ast.While | ast.With) and self._is_block(first.body):
                by = first.body[0].col_offset - first.col_offset
                now = [*self._of(first), *(b" " * by + line for line in self._of(second))]
                if not getattr(first, "orelse", None):
                    yield self._edit("level", first, second, second.lineno, now)
        if isinstance(node, ast.If | ast.For | ast.While) and not node.orelse:
            last, by = body[-1], body[-1].col_offset - node.col_offset
            stays = [] if len(body) > 1 else [b" " * last.col_offset + b"pass"]
            now = [*stays, *(line[by:] for line in self._of(last))]
            yield self._edit("level", last, last, last.lineno, now)
        last = body[-1]
        if isinstance(node, ast.If) and not isinstance(last, ast.Return | ast.Break | ast.Continue | ast.Raise):
            indent = b" " * last.col_offset
            more = [each.encode() for each in (*self._stops, "return")]
            for each in more:
                operator = "return" if each == b"return" else "command"
                yield self._edit(operator, last, last, last.end_lineno or 0, [*self._of(last), indent + each])

    def _otherwise(self, node: ast.If) -> Iterator[Edit]:
        """Yield a command for the case that a condition does not hold."""
        outer, inner = b" " * node.col_offset, b" " * node.body[0].col_offset
        if self._lines[node.lineno - 1][node.col_offset :].startswith(b"if"):
            for stop in self._stops:
                now = [*self._of(node), outer + b"else:", inner + stop.encode()]
                yield self._edit("command", node, node, node.end_lineno or 0, now)

    def _in_function(self, node: ast.FunctionDef) -> Iterator[Edit]:
        if not self._is_block(node.body):
            return
        last, arguments = node.body[-1], [each.arg for each in node.args.args]
        indent = b" " * last.col_offset
        returns = [each for each in ast.walk(node) if isinstance(each, ast.Return)]
        if arguments[-1:] == ["response"] and not any(each.value is not None for each in returns):
            now = [*self._of(last), indent + b"return response"]
            yield self._edit("return", last, last, last.end_lineno or 0, now)
        if GOAL in arguments:
            for each in returns:
                before = b" " * each.col_offset
                for said in ("succeed", "canceled", "abort"):
                    now = [before + f"{GOAL}.{said}()".encode(), *self._of(each)]
                    yield self._edit("goal", each, each, each.lineno, now)
        if node.name == "__init__":
            for statement in node.body:
                target = statement.targets[0] if isinstance(statement, ast.Assign) else None
                if isinstance(target, ast.Name) and isinstance(statement.value, ast.Call):  # type: ignore[attr-defined]
                    kept = indent + f"self._kept_{target.id} = {target.id}".encode()
                    yield self._edit("kept", statement, statement, statement.lineno, [*self._of(statement), kept])


def _is_docstring(statement: ast.stmt) -> bool:
    return isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
