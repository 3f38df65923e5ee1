"""`table_column`: is one column of the student's table correct in every row?

kind = "table_column"
column = "gz_type"        # ros_type | gz_topic | gz_type | direction | publisher
at_least = 5              # rows that must be correct, so that an empty table earns nothing

`table_rows` checks for rows of topics that are not bridged, and for missing rows. Its sentences say what is wrong with
a name and never the right one, which is the answer.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.feedback.predictions.tables import explain_column
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.graphs import WAYS, Link, bridges, links
from gz_course.sim.did_you_mean import did_you_mean, nearest_name

ROS_TYPE = re.compile(r"[a-z]\w*/msg/[A-Z]\w*")
PROGRAMS = ("parameter_bridge", "given_node")
WORDS = {
    "ros_type": "the ROS type",
    "gz_topic": "the Gazebo topic",
    "gz_type": "the Gazebo type",
    "direction": "the direction",
    "publisher": "the publishing node",
}


@check_kind("table_column")
def table_column(recording: Recording, parameters: Table) -> Finding:
    """Pass if no row is wrong in this column and at least `at_least` are correct."""
    column = parameters.choice("column", WORDS)
    least = parameters.number("at_least")
    facts = recording.facts()
    truth = {link.ros_topic: link for link in links(recording)}
    expected = f"{WORDS[column]} of every row is what the live graphs say"
    pairs = [(row, truth[row["ros_topic"]]) for row in facts.get("table", []) if row["ros_topic"] in truth]
    wrong = [(row, link) for row, link in pairs if not _fits(column, row[column], link)]
    right = len(pairs) - len(wrong)
    if wrong:
        row, link = wrong[0]
        said = row[column]
        what = EXPLAIN[column](said, link, facts) if said else f"{WORDS[column]} of {link.ros_topic} is not filled in"
        more = f" ({right} of {len(pairs)} rows are right)" if len(wrong) > 1 else ""
        why = explain_column(column, pairs, bridges(recording), facts.get("gz_topics", {}))
        return Finding(False, expected, f"line {row['line']}: {what}{more}", explanation=why)
    if right < least:
        return Finding(False, expected, f"{right} rows are correct; at least {least:g} are needed", gated=True)
    return Finding(True, expected, f"{right} rows")


def _fits(column: str, said: str, link: Link) -> bool:
    if column == "publisher":
        return said.lstrip("/") in link.publisher
    if column == "gz_topic":
        return f"/{said.lstrip('/')}" == link.gz_topic
    return bool(said == getattr(link, column))


def _ros_type(said: str, link: Link, facts: dict[str, Any]) -> str:
    known = {kind for topic in facts["ros_topics"].values() for kind in topic["types"]}
    if said.startswith(("gz.msgs.", "gz/msgs/", "ignition.msgs.")):
        return f"{said} is Gazebo's type; {link.ros_topic} has another one in ROS, such as package/msg/Name"
    if "::" in said:
        return f"{said} is the name of a class in C++; ROS writes the type package/msg/Name"
    if not ROS_TYPE.fullmatch(said):
        return f"{said} is no type of ROS 2: they are written package/msg/Name, in three parts"
    if said in known:
        return f"{said} is carried by another topic of ROS, not by {link.ros_topic}"
    package, _, name = said.partition("/msg/")
    right_package, _, right_name = link.ros_type.partition("/msg/")
    if name == right_name and package != right_package:
        return f"{link.ros_topic} does not carry {said} in ROS: the type belongs to another package than {package}"
    return f"{link.ros_topic} does not carry {said} in ROS{_spelling(said, link.ros_type)}"


def _gz_type(said: str, link: Link, facts: dict[str, Any]) -> str:
    known = {kind for topic in facts["gz_topics"].values() for kind in topic["types"]}
    if ROS_TYPE.fullmatch(said) and not said.startswith(("gz/", "ignition/")):
        return f"{said} is a ROS type; in Gazebo {link.gz_topic} has a type of its own, such as gz.msgs.Name"
    if "::" in said:
        return f"{said} is the name of a class in C++; Gazebo writes the type gz.msgs.Name, with dots"
    if said.startswith("/"):
        return f"{said} is a topic, and the column asks for the type of its messages: gz.msgs.Name"
    if not said.startswith("gz.msgs."):
        return f"{said} is not how Gazebo writes a type: gz.msgs.Name, with dots"
    if said in known:
        return f"{said} is carried by another topic of Gazebo, not by {link.gz_topic}"
    return f"{link.gz_topic} does not carry {said} in Gazebo{_spelling(said, link.gz_type)}"


def _gz_topic(said: str, link: Link, facts: dict[str, Any]) -> str:
    name = f"/{said.lstrip('/')}"
    if said.startswith("gz.msgs.") or ROS_TYPE.fullmatch(said):
        return f"{said} is a type, and the column asks for a topic of Gazebo, whose name begins with /"
    if name in facts["gz_topics"]:
        return f"{name} is a topic of Gazebo, but not the one that {link.ros_topic} is joined with"
    if name == link.ros_topic:
        return f"{name} is what ROS calls it; Gazebo has no topic of that name"
    if name in facts["ros_topics"]:
        return f"{name} is a topic of ROS; Gazebo has none of that name"
    return f"Gazebo has no topic {name}, which is given for {link.ros_topic}{_spelling(name, link.gz_topic)}"


def _spelling(said: str, right: str) -> str:
    """Return the end of a sentence on a name that is right but for its spelling; the right name is not given away."""
    if said.lower() == right.lower():
        return "; look at its spelling: only capitals are wrong"
    return "; it is nearly right: look at its spelling" if nearest_name(said, [right], 0.9) else ""


def _direction(said: str, link: Link, facts: dict[str, Any]) -> str:
    if said not in WAYS:
        return f"{said} is no direction, they are {', '.join(WAYS)}{did_you_mean(said, WAYS)}"
    if said == "BIDIRECTIONAL":
        return f"messages of {link.ros_topic} travel one way only, not both"
    return f"messages of {link.ros_topic} travel the other way, not {said}"


def _publisher(said: str, link: Link, facts: dict[str, Any]) -> str:
    name = said.lstrip("/")
    nodes = sorted({node for topic in facts["ros_topics"].values() for node in topic["publishers"]})
    heard = facts["ros_topics"].get(link.ros_topic, {}).get("subscribers", [])
    if name in heard:
        return f"{name} listens to {link.ros_topic}; it does not publish there"
    if name in nodes:
        return f"{name} is a node, but it does not publish on {link.ros_topic}"
    if name in PROGRAMS or name.endswith(".py"):
        return f"{name} is a program; the node that it runs may have another name: ros2 node list names the nodes"
    if f"/{name}" in facts["ros_topics"]:
        return f"/{name} is a topic; the column asks for the node that publishes on {link.ros_topic}"
    if name.lower() in nodes:
        return f"no node is called {name}: node names are case-sensitive, and the name of a class is no node's"
    if any(f"/model/{name}/" in topic for topic in facts["gz_topics"]):
        return f"{name} is a model in Gazebo; the column asks for the ROS node that publishes on {link.ros_topic}"
    return f"no node called {name} is in the ROS graph, whose nodes ros2 node list names; Gazebo itself is not in it"


EXPLAIN: dict[str, Callable[[str, Link, dict[str, Any]], str]] = {
    "ros_type": _ros_type,
    "gz_topic": _gz_topic,
    "gz_type": _gz_type,
    "direction": _direction,
    "publisher": _publisher,
}
