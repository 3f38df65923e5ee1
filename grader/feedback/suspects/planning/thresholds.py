"""Suspects in what decides how a map shows a cell: more observations than most cells get, or the later of two rules."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from typing import TypeGuard

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

COUNTS = re.compile(r"hit|pass|free|miss|seen|count|visit|evidence|score|odds", re.IGNORECASE)
MANY = 10  # observations, after which a scanner has turned elsewhere


@suspicion_of(About.THRESHOLD)
def many_observations(tree: ast.Module) -> Words:
    """Find `self.passes > 60`, by which a cell that was seen 60 times is still unknown."""
    if "OccupancyGrid" not in unparse(tree):
        return
    known = named_numbers(tree)
    for node in walk(tree):
        match node:
            case ast.Compare(left=counted, ops=[ast.Gt() | ast.GtE()], comparators=[limit]):
                pass
            case ast.Compare(left=limit, ops=[ast.Lt() | ast.LtE()], comparators=[counted]):
                pass
            case _:
                continue
        least, text = number(limit, known), unparse(counted)
        scanned = isinstance(counted, ast.Attribute | ast.Subscript) and COUNTS.search(text)
        if least is not None and least >= MANY and scanned and "len(" not in text:
            yield (
                node,
                f"{unparse(node)[:60]} asks for {least:g} observations of a cell, and most cells are seen less "
                "often: decide by which of hits and passes are more, from the first one on",
            )


@suspicion_of(About.ERASED)
def free_again(tree: ast.Module) -> Words:
    """Find `grid[hits > 0] = 100` before `grid[passes > 0] = 0`, where walls that rays have passed become free."""
    if "OccupancyGrid" not in unparse(tree):
        return
    for block in _blocks(tree):
        walls: dict[str, tuple[int, ast.expr]] = {}
        for statement in block:
            match statement:
                case ast.Assign(targets=[ast.Subscript(value=grid, slice=mask)], value=value):
                    shown = unparse(value).rpartition(".")[2]
                case _:
                    continue
            name = unparse(grid)
            if shown in ("100", "OCCUPIED"):
                walls[name] = statement.lineno, mask
            elif shown in ("0", "FREE") and name in walls:
                line, first = walls[name]
                if (
                    _alone(mask)
                    and isinstance(mask.comparators[0], ast.Constant)
                    and _alone(first)
                    and not _counted(mask) & _counted(first) - _counted(grid)
                ):
                    yield (
                        statement,
                        f"`{unparse(statement)[:70]}` comes after line {line}, `{unparse(first)[:50]}`, which "
                        "makes cells occupied: where both hold, as in walls that some ray has passed, the later one "
                        "counts, so they are free: exchange the two lines",
                    )


def _blocks(tree: ast.AST) -> Iterator[list[ast.stmt]]:
    for node in walk(tree):
        yield from (block for field in ("body", "orelse") if isinstance(block := getattr(node, field, None), list))


def _alone(mask: ast.expr) -> TypeGuard[ast.Compare]:
    """Return whether a mask is one condition on one kind of count."""
    return (
        isinstance(mask, ast.Compare) and len(mask.ops) == 1 and isinstance(mask.ops[0], ast.Gt | ast.GtE | ast.NotEq)
    )


def _counted(node: ast.expr) -> set[str]:
    """Return what is compared first in a mask."""
    left = node.left if isinstance(node, ast.Compare) else node
    names = nodes_of(left, ast.Attribute, ast.Name)
    return {unparse(each) for each in names} - {"self", "np"}
