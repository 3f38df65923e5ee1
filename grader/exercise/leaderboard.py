"""What a class is ranked by: numbers that checks measure.

    [[leaderboard]]
    name = "Time in the corridor [s]"
    check = "arrives"
    best = "lowest"        # or "highest"

Only a submission that passes the check is ranked. Of several trials the worst number counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from gz_course.grader.exercise.toml_table import Table

LOWEST, HIGHEST = "lowest", "highest"


@dataclass(frozen=True)
class Ranked:
    """A number by which a class is ranked."""

    name: str
    check: str  # its id
    best: str  # lowest | highest

    def worst(self, values: Sequence[float]) -> float:
        """Return the worst of the numbers of several trials."""
        return max(values) if self.best == LOWEST else min(values)


def read_leaderboard(tables: Sequence[Table]) -> tuple[Ranked, ...]:
    """Read `[[leaderboard]]`. Raises ManifestError if a table is wrong."""
    found = []
    for table in tables:
        found.append(Ranked(table.text("name"), table.text("check"), table.choice("best", (LOWEST, HIGHEST))))
        table.end()
    return tuple(found)
