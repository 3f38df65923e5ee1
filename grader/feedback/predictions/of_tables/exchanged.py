"""Two rows whose entries are exchanged."""

from __future__ import annotations

from gz_course.grader.feedback.predictions.tables import Column, explains_column


@explains_column("ros_type", "gz_topic", "gz_type")
def exchanged_rows(column: Column) -> str:
    """Recognise two rows of which each has in one column what belongs to the other."""
    name = column.name
    wrong = [(row, link) for row, link in column.pairs if row[name].lstrip("/") != getattr(link, name).lstrip("/")]
    if len(wrong) != 2:
        return ""
    (one, first), (two, second) = wrong
    crossed = ((one, second), (two, first))
    if any(row[name].lstrip("/") != getattr(link, name).lstrip("/") for row, link in crossed):
        return ""
    return (
        f"lines {one['line']} and {two['line']}: {one[name]} and {two[name]} are exchanged: each belongs to the "
        "other row"
    )
