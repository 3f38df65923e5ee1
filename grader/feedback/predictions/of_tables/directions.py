"""Directions of messages that were mistaken."""

from __future__ import annotations

from gz_course.grader.feedback.predictions.tables import LEAST, OTHER_WAY, Column, explains_column


@explains_column("direction")
def reversed_directions(column: Column) -> str:
    if len(column.pairs) < LEAST or any(
        row["direction"] != OTHER_WAY.get(link.direction) for row, link in column.pairs
    ):
        return ""
    return "every row says the opposite direction: it is that of the messages, from who publishes them to who listens"


@explains_column("direction")
def one_direction(column: Column) -> str:
    said = {row["direction"] for row, _ in column.pairs}
    if len(column.pairs) < LEAST or len(said) != 1 or not said <= {"BIDIRECTIONAL", *OTHER_WAY}:
        return ""
    if said == {"BIDIRECTIONAL"}:
        return "every row says BIDIRECTIONAL: on each topic, only one of the two sides publishes messages of its own"
    return f"every row says {said.pop()}, but not all messages travel the same way"


@explains_column("direction")
def configured_directions(column: Column) -> str:
    """Recognise the directions of the bridge's configuration, where it is open to both sides."""
    configured = {bridge.ros_topic: bridge.direction for bridge in column.bridges}
    wrong = [(row, link) for row, link in column.pairs if row["direction"] != link.direction]
    if not wrong or any(row["direction"] != configured.get(link.ros_topic) for row, link in wrong):
        return ""
    topic = wrong[0][1].ros_topic
    return (
        f"that is how the bridge of {topic} is configured, open to both sides; the column asks which way messages "
        "really travel, and only one side publishes any"
    )


@explains_column("direction")
def both_ends(column: Column) -> str:
    """Recognise that topics are said to go both ways, and no row has another fault."""
    wrong = [(row, link) for row, link in column.pairs if row["direction"] != link.direction]
    if len(wrong) < LEAST or any(row["direction"] != "BIDIRECTIONAL" for row, _ in wrong):
        return ""
    return (
        f"line {wrong[0][0]['line']}: messages of {wrong[0][1].ros_topic} travel one way only, and so do those of "
        f"{len(wrong) - 1} more rows: every topic has publishers and subscribers, and BIDIRECTIONAL is only one on "
        "which both sides publish messages of their own"
    )
