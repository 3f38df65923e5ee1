"""A map in the frame odom whose program subtracts the first position from all others, and never knows where it is."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, assigned, children, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip


@slip
def first_position_subtracted(tree: ast.AST) -> Iterator[Place]:
    """Find `p.x - self.start[0]`, where the start is kept once, and p.x is used for nothing else.

    Who adds the start again, or also uses the position as it is, may have a use for the difference.
    """
    used = {each.value for each in nodes_of(tree, ast.Constant) if isinstance(each.value, str)}
    names = {each.id for each in nodes_of(tree, ast.Name)}
    if "OccupancyGrid" not in names or not used & {"odom", "/odom"}:
        return
    parent = {child: node for node in walk(tree) for child in children(node)}
    raw = _positions(tree)
    kept = {name for name in _kept_once(tree, raw) if _only_subtracted(name, tree, parent)}
    left: dict[ast.AST, ast.BinOp] = {}
    for node in nodes_of(tree, ast.BinOp):
        if isinstance(node.op, ast.Sub) and _root(node.right) in kept:
            left[node.left] = node
    found = [left[each] for each in raw if each in left]
    if found and all(each in left or _is_kept(each, parent, kept) for each in raw):
        first = min(found, key=lambda each: (each.lineno, each.col_offset))
        yield (
            first.lineno,
            f"{unparse(first)[:60]} subtracts the first position from all others, so the map, and the place of the "
            "robot in it, are moved by the start: in the frame odom, positions of /odom are used as they are",
        )


def _positions(tree: ast.AST) -> list[ast.AST]:
    """Return where x and y of a position of a pose are read, or names to which they were assigned."""
    places = {unparse(to) for to, value in assigned(tree) if unparse(value).endswith("pose.position")}
    read = [
        node
        for node in nodes_of(tree, ast.Attribute)
        if node.attr in ("x", "y") and isinstance(node.ctx, ast.Load)
        if unparse(node.value) in places or unparse(node.value).endswith("pose.position")
    ]
    of_attributes = set(read)
    named = {to.id: value for to, value in assigned(tree) if isinstance(to, ast.Name) and value in of_attributes}
    stored = [node.id for node in nodes_of(tree, ast.Name) if isinstance(node.ctx, ast.Store)]
    named = {name: value for name, value in named.items() if stored.count(name) == 1}
    loads = [node for node in nodes_of(tree, ast.Name) if node.id in named and isinstance(node.ctx, ast.Load)]
    return [*(node for node in read if node not in named.values()), *loads]


def _root(node: ast.AST) -> str:
    """Return the attribute of self, or the name, of `self.start[0]` or `self.start.x`."""
    while isinstance(node, ast.Subscript | ast.Attribute):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self":
            return unparse(node)
        node = node.value
    return ""


def _kept_once(tree: ast.AST, raw: list[ast.AST]) -> set[str]:
    """Return the attributes that get a position behind a test that holds only once, and else only None or numbers."""
    positions = set(raw)
    kept: set[str] = set()
    others: set[str] = set()
    once = {
        id(each)
        for test in nodes_of(tree, ast.If)
        if _holds_once(test)
        for statement in test.body
        for each in walk(statement)
    }
    for to, value in assigned(tree):
        name = _root(to)
        if not name:
            continue
        if id(value) in once and positions & set(walk(value)):
            kept.add(name)
        elif not isinstance(value, ast.Constant) and not (isinstance(value, ast.Tuple) and not value.elts):
            others.add(name)
    return kept - others


def _holds_once(test: ast.If) -> bool:
    """Return whether a test asks for what its own body sets: `if self.start is None:`, `if not self.known:`."""
    set_here = {_root(to) for statement in test.body for to, _ in assigned(statement)}
    match test.test:
        case ast.Compare(left=asked, ops=[ast.Is()], comparators=[ast.Constant(value=None)]):
            return _root(asked) in set_here
        case ast.UnaryOp(op=ast.Not(), operand=asked) | (ast.Attribute() as asked):
            return _root(asked) in set_here
    return False


def _only_subtracted(name: str, tree: ast.AST, parent: dict[ast.AST, ast.AST]) -> bool:
    """Return whether an attribute is read only behind a minus sign, or in a test of whether it is set."""
    for node in walk(tree):
        if not (isinstance(node, ast.Attribute) and unparse(node) == name and isinstance(node.ctx, ast.Load)):
            continue
        whole: ast.AST = node
        while isinstance(parent[whole], ast.Subscript | ast.Attribute) and whole is not getattr(
            parent[whole], "slice", None
        ):
            whole = parent[whole]
        above = parent[whole]
        subtracted = isinstance(above, ast.BinOp) and isinstance(above.op, ast.Sub) and above.right is whole
        if not subtracted and not isinstance(above, ast.Compare | ast.UnaryOp | ast.If):
            return False
    return True


def _is_kept(node: ast.AST, parent: dict[ast.AST, ast.AST], kept: set[str]) -> bool:
    """Return whether a position is read to be kept as the start."""
    above = parent.get(node)
    while above is not None and not isinstance(above, ast.stmt):
        above = parent.get(above)
    return isinstance(above, ast.Assign) and all(
        _root(each) in kept
        for target in above.targets
        for each in (target.elts if isinstance(target, ast.Tuple) else [target])
    )
