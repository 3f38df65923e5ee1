"""Parts of Gazebo that were taken for nodes."""

from __future__ import annotations

from gz_course.grader.feedback.predictions.tables import LEAST, Column, explains_column


@explains_column("publisher")
def parts_of_gazebo(column: Column) -> str:
    """Recognise sensors and systems of Gazebo in place of the node that publishes what comes from there."""
    nodes = {node for _, link in column.pairs for node in link.publisher}
    wrong = [(row, link) for row, link in column.pairs if row["publisher"].lstrip("/") not in link.publisher]
    names = {row["publisher"].lstrip("/") for row, _ in wrong}
    if len(names) < LEAST or names & nodes or any(link.direction != "GZ_TO_ROS" for _, link in wrong):
        return ""
    return (
        f"line {wrong[0][0]['line']}: {wrong[0][0]['publisher']} and the like are parts of Gazebo and no nodes of ROS: "
        "all that comes from there is published in ROS by the node that carries it across"
    )
