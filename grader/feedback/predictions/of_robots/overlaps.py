"""Parts of a robot that start inside each other, as `gz sim` has warned of them."""

from __future__ import annotations

import re
from collections.abc import Iterable

from gz_course.grader.feedback.rules import guarded
from gz_course.grader.score.robots import LUMPED

PAIR = re.compile(r"'([^']+)' and '([^']+)' are ([\d.]+) m inside each other")


@guarded("")
def overlap(warnings: Iterable[str], robot: str) -> str:
    """Return which two parts of the robot overlap, and by how much; empty if none do."""
    for found in filter(None, map(PAIR.search, warnings)):
        one, other = (name.split("::") for name in found.groups()[:2])
        if one[0] == other[0] == robot:
            parts = f"{_part(one)} and {_part(other)}"
            return f"{parts} are {found[3]} m inside each other, and push each other away"
    return ""


def _part(scoped: list[str]) -> str:
    lumped = LUMPED.search(scoped[-1])
    return lumped[1] if lumped else scoped[1]
