"""Looks into a student's Python: one that is not Python, or is nested too deeply to be looked at, has no places."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from functools import lru_cache, wraps
from typing import Any, TypeVar, overload

from gz_course.grader.feedback.rules import ask

Place = tuple[int, str]  # line, and the words of a sentence
Places = list[dict[str, Any]]
Words = Iterator[str | tuple[int | ast.AST, str]]  # of a sentence about a node, or about another place than that
Node = TypeVar("Node", bound=ast.AST)
Value = TypeVar("Value")
One = TypeVar("One", bound=ast.AST)
Two = TypeVar("Two", bound=ast.AST)
Three = TypeVar("Three", bound=ast.AST)
# Nodes of a syntax tree, each counted once for every node above it: what it costs to look into each statement from
# each of those around it. The longest solution has a third of that.
MOST_WORK = 30_000
KEPT = "_kept"
GIVEN_UP = (SyntaxError, ValueError, RecursionError, MemoryError)
DEEPEST = 150  # levels of a syntax tree that rules follow; no solution has 50


class _Kept(dict[Any, Any]):
    """What was read from a node, by what was asked. A copy of the node carries it along, and does not believe it."""

    def __init__(self, node: ast.AST) -> None:
        super().__init__()
        self.node = node


def kept(read: Callable[[Node], Value]) -> Callable[[Node], Value]:
    """Let a node keep what a function of it alone returns: a hundred rules ask for the same. Nobody changes either."""

    @wraps(read)
    def ask(node: Node) -> Value:
        known: _Kept | None = node.__dict__.get(KEPT)
        if known is None or known.node is not node:
            known = node.__dict__[KEPT] = _Kept(node)
        if read not in known:
            known[read] = read(node)
        found: Value = known[read]
        return found

    return ask


@kept
def children(node: ast.AST) -> tuple[ast.AST, ...]:
    """Return the nodes right below a node."""
    return tuple(ast.iter_child_nodes(node))


@kept
def walk(node: ast.AST) -> tuple[ast.AST, ...]:
    """Return a node and all nodes below it, in the order of `ast.walk`."""
    found = [node]
    for each in found:
        found += children(each)
    return tuple(found)


@kept
def parents(tree: ast.AST) -> dict[ast.AST, ast.AST]:
    """Return the node above each node of a tree."""
    return {child: node for node in walk(tree) for child in children(node)}


@kept
def _by_kind(node: ast.AST) -> dict[Any, tuple[Any, ...]]:
    """Return the nodes of a tree in the order of `walk`, by their class; `nodes_of` adds groups of classes."""
    found: dict[Any, list[ast.AST]] = {}
    for each in walk(node):
        found.setdefault((type(each),), []).append(each)
    return {kinds: tuple(nodes) for kinds, nodes in found.items()}


@overload
def nodes_of(tree: ast.AST, kind: type[One], /) -> tuple[One, ...]: ...
@overload
def nodes_of(tree: ast.AST, one: type[One], two: type[Two], /) -> tuple[One | Two, ...]: ...
@overload
def nodes_of(tree: ast.AST, one: type[One], two: type[Two], three: type[Three], /) -> tuple[One | Two | Three, ...]: ...


def nodes_of(tree: ast.AST, *kinds: type[ast.AST]) -> tuple[Any, ...]:
    """Return the nodes of a tree that are of one of these classes, in the order of `walk`."""
    groups = _by_kind(tree)
    found = groups.get(kinds)
    if found is None:
        found = groups[kinds] = tuple(each for each in walk(tree) if isinstance(each, kinds))
    return found


@kept
def unparse(node: ast.AST) -> str:
    """Return the text of a node, as `ast.unparse` writes it."""
    return ast.unparse(node)


def functions(tree: ast.AST) -> tuple[ast.FunctionDef, ...]:
    return nodes_of(tree, ast.FunctionDef)


def last_name(node: ast.AST) -> str:
    """Return the last part of a name, such as `Node` of `launch_ros.actions.Node`; empty if it is no name."""
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""


@kept
def calls(tree: ast.AST) -> tuple[tuple[ast.Call, str], ...]:
    """Return every call with the last part of the name that is called: `cos` of `math.cos(x)`."""
    return tuple((node, last_name(node.func)) for node in nodes_of(tree, ast.Call))


@kept
def called(tree: ast.AST) -> frozenset[str]:
    """Return the last parts of the names of all that is called."""
    return frozenset(name for _, name in calls(tree))


@kept
def assigned(tree: ast.AST) -> tuple[tuple[ast.expr, ast.expr], ...]:
    """Return every target of an assignment with its value; the parts of tuples one by one."""
    found: list[tuple[ast.expr, ast.expr]] = []
    for node in nodes_of(tree, ast.Assign, ast.AugAssign, ast.AnnAssign):
        if not isinstance(node, ast.Assign):
            found += [(node.target, node.value)] if node.value is not None else []
            continue
        for target in node.targets:
            if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
                found += zip(target.elts, node.value.elts, strict=False)
            else:
                found.append((target, node.value))
    return tuple(found)


@kept
def set_to(tree: ast.AST) -> dict[str, list[ast.expr]]:
    """Return what each name and attribute of a file is set to."""
    found: dict[str, list[ast.expr]] = {}
    for target, value in assigned(tree):
        found.setdefault(unparse(target), []).append(value)
    return found


def is_none(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def left_early(loop: ast.AST) -> bool:
    """Return whether a loop has a `break` or a `return` in it."""
    return bool(nodes_of(loop, ast.Break, ast.Return))


def hands_over(loop: ast.AST) -> bool:
    """Return whether each round of a loop leaves its function for a while: that of a generator or a coroutine."""
    return bool(nodes_of(loop, ast.Yield, ast.YieldFrom, ast.Await))


def assignments(tree: ast.AST) -> Iterator[tuple[ast.expr, ast.Assign]]:
    """Yield each assignment to a single target, after the target."""
    return ((node.targets[0], node) for node in nodes_of(tree, ast.Assign) if len(node.targets) == 1)


def asked_of(
    rule: Callable[..., Words], *kinds: type[ast.AST], first: bool = False
) -> Callable[[ast.Module], Iterator[Place]]:
    """Let a rule of nodes of some classes, or of the whole tree if there are none, be one that finds lines and words.

    A rule that takes two arguments gets the tree as the second one. With `first`, what it finds first is enough.
    """
    with_tree = rule.__code__.co_argcount > 1

    @wraps(rule)
    def find(tree: ast.Module) -> Iterator[Place]:
        for node in nodes_of(tree, *kinds) if kinds else (tree,):
            for found in rule(node, tree) if with_tree else rule(node):
                where, words = (node, found) if isinstance(found, str) else found
                yield (where if isinstance(where, int) else where.lineno), words  # type: ignore[attr-defined]
                if first:
                    return

    return find


def places_in(content: bytes, look: Callable[[ast.Module], Places]) -> Places:
    """Return what `look` finds in the syntax tree of a file; nothing if Python gives up parsing it.

    A file that is far longer or deeper than any solution has none: rules compare its statements with each other.
    """
    try:
        tree = _parsed(content)
        return ask(look, [], tree) if _work(tree) <= MOST_WORK else []
    except GIVEN_UP:
        return []


def parsed(content: bytes) -> ast.Module:
    """Return the syntax tree of a file; an empty one if Python gives up parsing it."""
    try:
        return _parsed(content)
    except GIVEN_UP:
        return ast.Module(body=[], type_ignores=[])


@lru_cache(maxsize=8)  # a grading looks into the same few files for a dozen kinds of places
def _parsed(content: bytes) -> ast.Module:
    return ast.parse(content)


@kept
def _work(tree: ast.AST) -> int:
    work, level, depth = 0, [tree], 0
    while level and work <= MOST_WORK and depth <= DEEPEST:
        work += len(level) * depth
        level = [child for node in level for child in children(node)]
        depth += 1
    return work if depth <= DEEPEST else MOST_WORK + 1


def returned_by(function: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda) -> list[ast.expr | None]:
    """Return the values that a function itself returns, without the functions inside it; None for a bare return."""
    if isinstance(function, ast.Lambda):
        return [function.body]
    inner = {
        id(each)
        for node in nodes_of(function, ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
        if node is not function
        for each in walk(node)
    }
    return [each.value for each in nodes_of(function, ast.Return) if id(each) not in inner]
