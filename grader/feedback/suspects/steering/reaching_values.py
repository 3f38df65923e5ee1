"""The expressions that a name of a function may hold at a place: what was assigned before, on every way there."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.slips.language.names import calls_of_own, parameters

Path = tuple[int, ...]
At = tuple[ast.expr, ast.FunctionDef]  # an expression, and the function it stands in


class UnknownValueError(Exception):
    """A value that cannot be followed, such as one that an `if` limits."""


class ReachingValues:
    """What names hold, looked up in the syntax tree of one file."""

    def __init__(self, tree: ast.AST) -> None:
        self.tree = tree
        self.own = {function.name: function for function in functions(tree)}
        self._paths = {function.name: dict(_paths(function.body, ())) for function in functions(tree)}

    def of(self, name: ast.expr, function: ast.FunctionDef) -> list[At]:
        """Return all that a name may hold where it is read; nothing if no assignment says it."""
        text, paths = unparse(name), self._paths[function.name]
        before = [
            node
            for node in paths
            if isinstance(node, ast.Assign | ast.AugAssign | ast.AnnAssign)
            and node.lineno < name.lineno
            and any(unparse(each) == text for each in _targets(node))
        ]
        before.sort(key=lambda node: node.lineno)
        read = next((path for node, path in reversed(paths.items()) if _holds(node, name)), ())
        sure = [number for number, node in enumerate(before) if read[: len(paths[node]) - 1] == paths[node][:-1]]
        before = before[sure[-1] if sure else 0 :]
        first = before[0].lineno if before else 0
        for node in paths:
            if isinstance(node, ast.If) and first < node.lineno < name.lineno and _limits(node, text):
                raise UnknownValueError
        if not before:
            return list(self._given(text, function))
        return [at for node in before for at in self._assigned(node, text, function)]

    def returned(self, function: ast.FunctionDef, place: int | None = None) -> list[At]:
        """Return what a function of the file returns, or the item at a place of each tuple."""
        found: list[At] = []
        for node in nodes_of(function, ast.Return):
            if node.value is None:
                continue
            value = node.value
            if place is not None and isinstance(value, ast.Tuple) and place < len(value.elts):
                value = value.elts[place]
            elif place is not None and (isinstance(value, ast.Name) or last_name(_function(value)) in self.own):
                raise UnknownValueError
            found.append((value, function))
        if not found:
            raise UnknownValueError
        return found

    def _assigned(self, node: ast.stmt, text: str, function: ast.FunctionDef) -> Iterator[At]:
        """Yield what an assignment gives to one of its targets; nothing for an item of what is no tuple."""
        value: ast.expr = node.value  # type: ignore[attr-defined]
        if isinstance(node, ast.AugAssign):
            old = ast.copy_location(ast.parse(text, mode="eval").body, node)
            yield ast.copy_location(ast.BinOp(old, node.op, node.value), node), function
            return
        for target in node.targets if isinstance(node, ast.Assign) else [node.target]:  # type: ignore[attr-defined]
            if unparse(target) == text:
                yield value, function
            elif isinstance(target, ast.Tuple) and text in map(unparse, target.elts):
                place = [unparse(each) for each in target.elts].index(text)
                if isinstance(value, ast.Tuple) and len(value.elts) == len(target.elts):
                    yield value.elts[place], function
                elif own := self.own.get(last_name(_function(value))):
                    yield from self.returned(own, place)

    def _given(self, text: str, function: ast.FunctionDef) -> Iterator[At]:
        """Yield what the calls of a function in the file pass for one of its parameters."""
        if text.startswith("self.") and any(
            text in map(unparse, _targets(node)) for node in nodes_of(self.tree, ast.stmt)
        ):
            raise UnknownValueError  # another function sets it
        if text not in parameters(function) or text == "self":
            return
        for own, given in calls_of_own(self.tree):
            for call in given if own is function else ():
                arguments = dict(zip(parameters(function), call.args, strict=False))
                arguments |= {word.arg: word.value for word in call.keywords if word.arg}
                if text not in arguments:
                    raise UnknownValueError
                caller = next((each for each in functions(self.tree) if any(n is call for n in walk(each))), None)
                if caller is None:
                    raise UnknownValueError
                yield arguments[text], caller


def _function(value: ast.expr) -> ast.expr:
    """Return what is called; the expression itself if it is no call."""
    return value.func if isinstance(value, ast.Call) else value


def _paths(body: list[ast.stmt], above: Path) -> Iterator[tuple[ast.stmt, Path]]:
    """Yield the statements of a function, outer ones first, each with the blocks it lies in."""
    for statement in body:
        yield statement, (*above, id(statement))
        for _, value in ast.iter_fields(statement):
            if isinstance(value, list) and value and isinstance(value[0], ast.stmt):
                yield from _paths(value, (*above, id(value)))


def _targets(node: ast.stmt) -> list[ast.expr]:
    given = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    return [
        part for each in given if each is not None for part in (each.elts if isinstance(each, ast.Tuple) else [each])
    ]


def _holds(statement: ast.stmt, name: ast.expr) -> bool:
    """Say whether a name is read in a statement; one that was made for `+=` has the line of it alone."""
    return any(each is name for each in walk(statement)) or (
        isinstance(statement, ast.AugAssign) and statement.lineno == name.lineno
    )


def _limits(node: ast.If, text: str) -> bool:
    """Say whether an `if` compares a name, and sets it."""
    compared = any(unparse(each) == text for each in walk(node.test))
    return compared and any(text in map(unparse, _targets(each)) for each in nodes_of(node, ast.stmt))
