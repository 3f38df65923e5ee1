"""`table_rows`: does the student's table have a row for every bridged topic, and no other?

kind = "table_rows"
"""

from __future__ import annotations

from collections import Counter

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.feedback.predictions.tables import missing_rows
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.graphs import links
from gz_course.grader.score.topic_faults import OWN_TOPICS
from gz_course.sim.did_you_mean import nearest_name


@check_kind("table_rows")
def table_rows(recording: Recording, parameters: Table) -> Finding:
    """Pass if the topics of the rows are exactly those that the bridge connects."""
    facts = recording.facts()
    rows = facts.get("table", [])
    wanted = [link.ros_topic for link in links(recording)]
    named = Counter(row["ros_topic"] for row in rows)
    expected = f"one row for each of the {len(wanted)} bridged topics"
    for row in rows:
        topic, where = row["ros_topic"], f"line {row['line']}"
        if not topic:
            single = (
                "" if len(row) > 1 else ", and one column only: a dash begins a row, so only its first line has one"
            )
            return Finding(False, expected, f"{where}: this row has no ros_topic{single}")
        if topic in wanted and named[topic] == 1:
            continue
        return Finding(False, expected, f"{where}: {_why(topic, named[topic], wanted, facts)}")
    missing = [topic for topic in wanted if topic not in named]
    if missing:
        more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
        why = missing_rows(missing, links(recording), facts.get("ros_topics", {}))
        return Finding(False, expected, f"there is no row for {missing[0]}{more}", explanation=why)
    return Finding(True, expected, f"{len(rows)} rows")


def _why(topic: str, times: int, wanted: list[str], facts: dict) -> str:
    """Return what is wrong with a row for this topic."""
    if topic in wanted:
        return f"{topic} has {times} rows; one is enough"
    ros, gz = facts.get("ros_topics", {}), facts.get("gz_topics", {})
    if topic in ros or topic in OWN_TOPICS:
        return f"{topic} is a topic of ROS alone; nothing of it goes across the bridge"
    if topic in gz:
        if any(bridge["gz_topic"] == topic for bridge in facts["bridges"]):
            return f"{topic} is what Gazebo calls it; in ROS it has another name, which bridge.yaml says"
        return f"{topic} is a topic of Gazebo alone; no bridge takes it to ROS"
    if f"/{topic}" in wanted:
        return f"the name of the topic begins with a slash: /{topic}"
    near = "; it is nearly right: look at its spelling" if nearest_name(topic, wanted, 0.8) else ""
    return f"there is no topic {topic} in ROS{near}"
