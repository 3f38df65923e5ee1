"""Why the two ends of the distance have different names, and what has ended a program; used by `checks.py`."""

from __future__ import annotations

from typing import Any

from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.grader.score.launched import own_end
from gz_course.sim.did_you_mean import nearest_name


def of_a_remapping(rules: list[Any], ends: list[Any], sends: str, takes: str) -> str:
    """Return why a remapping in the launch file does not join two topics: it is for another name, or exchanged."""
    for each in rules:
        space = f"/{each['namespace']}" if each["namespace"] else ""
        old, new = (name if name.startswith("/") else f"{space}/{name}" for name in (each["from"], each["to"]))
        for end in ends:
            used, other = end["topic"], {sends: takes, takes: sends}.get(end["topic"])
            if other is None or end["node"].rpartition("/")[0] != space:
                continue
            place = f"{each['file']}, line {each['line']}"
            if new == other and old != used:
                means = "" if each["from"] == old else f", which means {old} in the namespace {space or '/'}"
                return f"{place}: the remapping is for the name {each['from']!r}{means}; the node's topic is {used}"
            if (old, new) == (other, used):
                return (
                    f"{place}: a remapping is (name in the node, new name); here, they are exchanged, or it stands at "
                    f"the wrong node: {each['from']} is the name in the other one"
                )
            if old == new == used and each["to"].startswith("/"):
                return f"{place}: this remapping changes nothing, because {each['from']!r} already means {new} here"
            if space and new == used and not each["to"].startswith("/"):
                return (
                    f"{place}: the new name {each['to']!r} in the remapping has no slash at its beginning, so it means "
                    f"{new}; the other node uses {other}"
                )
    return ""


def of_a_spelling(sends: str, takes: str) -> str:
    """Return that two topics are the same but for a letter or two; empty if they differ in a whole part."""
    if sends.count("/") != takes.count("/") or not nearest_name(sends, [takes], cutoff=0.85):
        return ""
    return f"{sends} and {takes} are spelled differently: both ends need the very same name"


def of_a_node(ends: list[Any], topics: set[str]) -> str:
    """Return why a topic has the name of a node, or of its namespace, in front."""
    for end in ends:
        namespace = end["node"].rpartition("/")[0]
        for topic in sorted(topics):
            if topic.startswith(f"{end['node']}/"):
                return f"{topic} begins with the name of the node {end['node']}, and the other side's name does not"
            if end["topic"] == topic and namespace and topic.startswith(f"{namespace}/"):
                return (
                    f"{end['node']} lives in the namespace {namespace}, and a name without a slash at its beginning is "
                    "put into it"
                )
    return ""


def ended_by_itself(recording: Recording, ended: dict[str, Any], expected: str) -> Finding:
    """Return the finding about a program that ended without an error, with the line that ends it if one is known."""
    why = "" if ended["code"] else own_end(recording, ended["program"])
    measured = f"{ended['program']} had ended with exit code {ended['code']}"
    return Finding(False, expected, measured, explanation=why)
