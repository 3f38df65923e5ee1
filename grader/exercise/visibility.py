"""Who sees what of a check or a trial: `visibility` in `[[check]]` and `[[trial]]`.

    visibility = "always"               # the default of checks, and of the trials in a manifest
    visibility = "after the deadline"
    visibility = "never"                # the default of the trials in `trials.toml`

It decides on what students are told (`grader/report/seen.py`), and never on points.
"""

from __future__ import annotations

from gz_course.grader.exercise.toml_table import Table

ALWAYS, AFTER, NEVER = "always", "after the deadline", "never"
VISIBILITIES = (ALWAYS, AFTER, NEVER)


def read_visibility(table: Table, otherwise: str = ALWAYS) -> str:
    """Return the visibility that a table gives. Raises ManifestError if there is no such word."""
    return table.choice("visibility", VISIBILITIES) if table.has("visibility") else otherwise
