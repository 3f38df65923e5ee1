"""What a student who filled in a table of topics with one misconception wrote into a whole column, or left out.

Each function returns the words of a sentence, or an empty text if the table does not fit. None of them holds a right
value: the table is an exercise in finding them.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import Any

from gz_course.grader.score.graphs import Bridged, Link

LEAST = 3  # rows that must fit: two can be alike by chance
OTHER_WAY = {"GZ_TO_ROS": "ROS_TO_GZ", "ROS_TO_GZ": "GZ_TO_ROS"}

Row = dict[str, Any]
Pairs = Sequence[tuple[Row, Link]]


def explain_column(column: str, pairs: Pairs, bridges: Sequence[Bridged], gz_topics: Collection[str]) -> str:
    """Return the misconception behind a wrong column; `pairs` are the rows of bridged topics with the truth."""
    filled = [(row, link) for row, link in pairs if row[column]]
    if column in ("ros_type", "gz_topic", "gz_type") and (said := exchanged_rows(column, filled)):
        return said
    if column == "gz_topic":
        return names_below_the_model(filled, gz_topics) or another_model(filled, gz_topics)
    return next((said for look in LOOKS.get(column, ()) if (said := look(filled, bridges))), "")


def exchanged_rows(column: str, pairs: Pairs) -> str:
    """Recognise two rows of which each has in one column what belongs to the other."""
    wrong = [(row, link) for row, link in pairs if row[column].lstrip("/") != getattr(link, column).lstrip("/")]
    if len(wrong) != 2:
        return ""
    (one, first), (two, second) = wrong
    crossed = ((one, second), (two, first))
    if any(row[column].lstrip("/") != getattr(link, column).lstrip("/") for row, link in crossed):
        return ""
    return (
        f"lines {one['line']} and {two['line']}: {one[column]} and {two[column]} are exchanged: each belongs to the "
        "other row"
    )


def reversed_directions(pairs: Pairs, bridges: Sequence[Bridged]) -> str:
    if len(pairs) < LEAST or any(row["direction"] != OTHER_WAY.get(link.direction) for row, link in pairs):
        return ""
    return "every row says the opposite direction: it is that of the messages, from who publishes them to who listens"


def one_direction(pairs: Pairs, bridges: Sequence[Bridged]) -> str:
    said = {row["direction"] for row, _ in pairs}
    if len(pairs) < LEAST or len(said) != 1 or not said <= {"BIDIRECTIONAL", *OTHER_WAY}:
        return ""
    if said == {"BIDIRECTIONAL"}:
        return "every row says BIDIRECTIONAL: on each topic, only one of the two sides publishes messages of its own"
    return f"every row says {said.pop()}, but not all messages travel the same way"


def configured_directions(pairs: Pairs, bridges: Sequence[Bridged]) -> str:
    """Recognise the directions of the bridge's configuration, where it is open to both sides."""
    configured = {bridge.ros_topic: bridge.direction for bridge in bridges}
    wrong = [(row, link) for row, link in pairs if row["direction"] != link.direction]
    if not wrong or any(row["direction"] != configured.get(link.ros_topic) for row, link in wrong):
        return ""
    topic = wrong[0][1].ros_topic
    return (
        f"that is how the bridge of {topic} is configured, open to both sides; the column asks which way messages "
        "really travel, and only one side publishes any"
    )


def both_ends(pairs: Pairs, bridges: Sequence[Bridged]) -> str:
    """Recognise that topics are said to go both ways, and no row has another fault."""
    wrong = [(row, link) for row, link in pairs if row["direction"] != link.direction]
    if len(wrong) < LEAST or any(row["direction"] != "BIDIRECTIONAL" for row, _ in wrong):
        return ""
    return (
        f"line {wrong[0][0]['line']}: messages of {wrong[0][1].ros_topic} travel one way only, and so do those of "
        f"{len(wrong) - 1} more rows: every topic has publishers and subscribers, and BIDIRECTIONAL is only one on "
        "which both sides publish messages of their own"
    )


def names_of_ros_types(pairs: Pairs, bridges: Sequence[Bridged]) -> str:
    """Recognise Gazebo types that are made of the names of the ROS types."""
    wrong = [(row, link) for row, link in pairs if row["gz_type"] != link.gz_type]
    if not wrong or any(row["gz_type"] != f"gz.msgs.{link.ros_type.rpartition('/')[2]}" for row, link in wrong):
        return ""
    return (
        f"line {wrong[0][0]['line']}: {wrong[0][0]['gz_type']} is the name that the type has in ROS with Gazebo's "
        "prefix; the two often have different names, if only in their capitals"
    )


def names_of_gz_types(pairs: Pairs, bridges: Sequence[Bridged]) -> str:
    """Recognise ROS types that are made of the names of the Gazebo types."""
    wrong = [(row, link) for row, link in pairs if row["ros_type"] != link.ros_type]
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


def names_below_the_model(pairs: Pairs, gz_topics: Collection[str]) -> str:
    """Recognise topics that do not exist in Gazebo because they were put below the model or the world."""
    wrong = [(row, link) for row, link in pairs if f"/{row['gz_topic'].lstrip('/')}" != link.gz_topic]
    for start, words in (("/model/", "the model's"), ("/world/", "the world's")):
        if wrong and all(
            row["gz_topic"].startswith(start)
            and not link.gz_topic.startswith(start)
            and row["gz_topic"] not in gz_topics
            for row, link in wrong
        ):
            return (
                f"line {wrong[0][0]['line']}: {wrong[0][0]['gz_topic']} has {words} name in it; not every topic has: "
                "one that a sensor's <topic> names is called just that"
            )
    return ""


def another_model(pairs: Pairs, gz_topics: Collection[str]) -> str:
    """Recognise topics below a model that this world does not have."""
    wrong = [(row, link) for row, link in pairs if f"/{row['gz_topic'].lstrip('/')}" != link.gz_topic]
    parts = [(f"/{row['gz_topic'].lstrip('/')}".split("/"), link.gz_topic.split("/")) for row, link in wrong]
    names = {said[2] for said, _ in parts if len(said) > 3}
    if len(names) != 1 or any(topic.startswith(f"/model/{name}/") for name in names for topic in gz_topics):
        return ""
    if any(said[:2] != ["", "model"] or right[:2] != said[:2] or said[3:] != right[3:] for said, right in parts):
        return ""
    row = wrong[0][0]
    return (
        f"line {row['line']}: {row['gz_topic']} begins with the name of a model, {names.pop()}, and no model of this "
        "world has that name: gz topic -l shows the topics with the name of its robot"
    )


def parts_of_gazebo(pairs: Pairs, bridges: Sequence[Bridged]) -> str:
    """Recognise sensors and systems of Gazebo in place of the node that publishes what comes from there."""
    nodes = {node for _, link in pairs for node in link.publisher}
    wrong = [(row, link) for row, link in pairs if row["publisher"].lstrip("/") not in link.publisher]
    names = {row["publisher"].lstrip("/") for row, _ in wrong}
    if len(names) < LEAST or names & nodes or any(link.direction != "GZ_TO_ROS" for _, link in wrong):
        return ""
    return (
        f"line {wrong[0][0]['line']}: {wrong[0][0]['publisher']} and the like are parts of Gazebo and no nodes of ROS: "
        "all that comes from there is published in ROS by the node that carries it across"
    )


LOOKS: dict[str, tuple[Callable[[Pairs, Sequence[Bridged]], str], ...]] = {
    "direction": (reversed_directions, one_direction, configured_directions, both_ends),
    "gz_type": (names_of_ros_types,),
    "ros_type": (names_of_gz_types,),
    "publisher": (parts_of_gazebo,),
}


def missing_rows(missing: Sequence[str], links: Sequence[Link], ros: dict[str, Any]) -> str:
    """Return what the topics without a row have in common; empty if nothing."""
    if not missing:
        return ""
    bridge = {node for link in links if link.direction == "GZ_TO_ROS" for node in link.publisher}
    heard = {link.ros_topic: set(ros.get(link.ros_topic, {}).get("subscribers", [])) - bridge for link in links}
    silent = [topic for topic, nodes in heard.items() if not nodes]
    to_gz = [link.ros_topic for link in links if link.direction == "ROS_TO_GZ"]
    if sorted(missing) == sorted(to_gz):
        return "what travels from ROS to Gazebo goes across, too"
    if set(missing) <= set(silent) and len(missing) > 1:
        return (
            "no node in ROS listens to the topics without a row; they go across all the same, because the "
            "bridge publishes them"
        )
    return ""
