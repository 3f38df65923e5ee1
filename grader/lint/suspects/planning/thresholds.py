"""Suspects in how often a cell must have been seen before a map shows it: so often that most cells never are."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.lint.constants import named_numbers, number
from gz_course.grader.lint.syntax import Suspect, walk

COUNTS = re.compile(r"hit|pass|free|miss|seen|count|visit|evidence|score|odds", re.IGNORECASE)
MANY = 10  # observations, after which a scanner has turned elsewhere


def many_observations(tree: ast.Module) -> Iterator[Suspect]:
    """Find `self.passes > 60`, by which a cell that was seen 60 times is still unknown."""
    if "OccupancyGrid" not in ast.unparse(tree):
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
        least, text = number(limit, known), ast.unparse(counted)
        scanned = isinstance(counted, ast.Attribute | ast.Subscript) and COUNTS.search(text)
        if least is not None and least >= MANY and scanned and "len(" not in text:
            yield (
                node.lineno,
                "threshold",
                f"{ast.unparse(node)[:60]} asks for {least:g} observations of a cell, and most cells are seen less "
                "often: decide by which of hits and passes are more, from the first one on",
            )


LOOKS = (many_observations,)
