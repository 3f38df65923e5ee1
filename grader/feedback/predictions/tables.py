"""What a student who filled in a table of topics with one misconception wrote into a whole column, or left out.

Each function of `of_tables/` returns the words of a sentence, or an empty text if the table does not fit. None of them
holds a right value: the table is an exercise in finding them.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Any

from gz_course.grader.feedback.rules import Room, ask, guarded
from gz_course.grader.score.graphs import Bridged, Link

LEAST = 3  # rows that must fit: two can be alike by chance
OTHER_WAY = {"GZ_TO_ROS": "ROS_TO_GZ", "ROS_TO_GZ": "GZ_TO_ROS"}

Row = dict[str, Any]
Pairs = Sequence[tuple[Row, Link]]


@dataclass(frozen=True)
class Column:
    """A wrong column: its name, its filled rows with the truth, the bridges, and the topics that Gazebo has."""

    name: str
    pairs: Pairs
    bridges: Sequence[Bridged]
    gz_topics: Collection[str]


Rule = Callable[[Column], str]
ROOM: Room[tuple[frozenset[str], Rule]] = Room(f"{__name__.rpartition('.')[0]}.of_tables")


def explains_column(*names: str) -> Callable[[Rule], Rule]:
    """Register an explanation of wrong entries in the columns of these names."""

    def register(function: Rule) -> Rule:
        ROOM.add((frozenset(names), function), function)
        return function

    return register


def explain_column(column: str, pairs: Pairs, bridges: Sequence[Bridged], gz_topics: Collection[str]) -> str:
    """Return the misconception behind a wrong column; `pairs` are the rows of bridged topics with the truth."""
    asked = Column(column, [(row, link) for row, link in pairs if row[column]], bridges, gz_topics)
    rules = (rule for names, rule in ROOM.rules() if column in names)
    return next((said for rule in rules if (said := ask(rule, "", asked))), "")


@guarded("")
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
