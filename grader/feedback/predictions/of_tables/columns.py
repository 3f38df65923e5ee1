"""What fills a column of a table of topics with one misconception: directions, types, topics, publishers, rows."""

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


@explains_column("gz_topic")
def names_below_the_model(column: Column) -> str:
    """Recognise topics that do not exist in Gazebo because they were put below the model or the world."""
    wrong = [(row, link) for row, link in column.pairs if f"/{row['gz_topic'].lstrip('/')}" != link.gz_topic]
    for start, words in (("/model/", "the model's"), ("/world/", "the world's")):
        if wrong and all(
            row["gz_topic"].startswith(start)
            and not link.gz_topic.startswith(start)
            and row["gz_topic"] not in column.gz_topics
            for row, link in wrong
        ):
            return (
                f"line {wrong[0][0]['line']}: {wrong[0][0]['gz_topic']} has {words} name in it; not every topic has: "
                "one that a sensor's <topic> names is called just that"
            )
    return ""


@explains_column("gz_topic")
def another_model(column: Column) -> str:
    """Recognise topics below a model that this world does not have."""
    wrong = [(row, link) for row, link in column.pairs if f"/{row['gz_topic'].lstrip('/')}" != link.gz_topic]
    parts = [(f"/{row['gz_topic'].lstrip('/')}".split("/"), link.gz_topic.split("/")) for row, link in wrong]
    names = {said[2] for said, _ in parts if len(said) > 3}
    if len(names) != 1 or any(topic.startswith(f"/model/{name}/") for name in names for topic in column.gz_topics):
        return ""
    if any(said[:2] != ["", "model"] or right[:2] != said[:2] or said[3:] != right[3:] for said, right in parts):
        return ""
    row = wrong[0][0]
    return (
        f"line {row['line']}: {row['gz_topic']} begins with the name of a model, {names.pop()}, and no model of this "
        "world has that name: gz topic -l shows the topics with the name of its robot"
    )


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
