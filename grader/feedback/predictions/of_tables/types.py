"""Types of one side that were made of the names of the other side's."""

from __future__ import annotations

from gz_course.grader.feedback.predictions.tables import Column, explains_column


@explains_column("gz_type")
def names_of_ros_types(column: Column) -> str:
    """Recognise Gazebo types that are made of the names of the ROS types."""
    wrong = [(row, link) for row, link in column.pairs if row["gz_type"] != link.gz_type]
    if not wrong or any(row["gz_type"] != f"gz.msgs.{link.ros_type.rpartition('/')[2]}" for row, link in wrong):
        return ""
    return (
        f"line {wrong[0][0]['line']}: {wrong[0][0]['gz_type']} is the name that the type has in ROS with Gazebo's "
        "prefix; the two often have different names, if only in their capitals"
    )


@explains_column("ros_type")
def names_of_gz_types(column: Column) -> str:
    """Recognise ROS types that are made of the names of the Gazebo types."""
    wrong = [(row, link) for row, link in column.pairs if row["ros_type"] != link.ros_type]
    if not wrong or any(
        row["ros_type"].count("/") != 2
        or row["ros_type"].rpartition("/")[2] != link.gz_type.rpartition(".")[2]
        or row["ros_type"].rpartition("/")[2] == link.ros_type.rpartition("/")[2]
        for row, link in wrong
    ):
        return ""
    return (
        f"line {wrong[0][0]['line']}: {wrong[0][0]['ros_type']} ends in the name that the type has in Gazebo; in ROS "
        "it has another one, if only in its capitals"
    )
