"""`bridge_qos`: does the bridge offer a ROS topic with the wanted quality of service?

kind = "bridge_qos"
ros_topic = "/image"
depth = [1, 2]            # messages kept for a slow listener: at least, at most
reliability = "RELIABLE"  # optional
at_least = 10             # messages that must have passed, so that doing nothing earns nothing
"""

from __future__ import annotations

from collections.abc import Sequence

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.graphs import bridges


@check_kind("bridge_qos")
def bridge_qos(recording: Recording, parameters: Table) -> Finding:
    """Pass if every bridge that publishes on the topic offers this depth and reliability."""
    topic = parameters.text("ros_topic")
    low, high = parameters.numbers("depth", [2])
    reliability = parameters.text("reliability") if parameters.has("reliability") else None
    least = parameters.number("at_least", above=0)
    span = f"{low:g}" if low == high else f"{low:g} to {high:g}"
    expected = f"{topic} keeps {span} message{'' if high == 1 else 's'}" + (f", {reliability}" if reliability else "")
    made = [bridge for bridge in bridges(recording) if bridge.ros_topic == topic and bridge.publisher_qos]
    if sum(bridge.to_ros for bridge in made) < least:
        return Finding(False, expected, f"no messages go to {topic}", gated=True)
    for bridge in made:
        offer = bridge.publisher_qos
        assert offer is not None
        if not low <= offer.depth <= high:
            why = _why(recording, topic, (low, high))
            measured = f"{bridge.place}: {topic} keeps {offer.depth} messages (publisher_queue)"
            return Finding(False, expected, measured, explanation=why)
        if reliability and offer.reliability != reliability:
            return Finding(False, expected, f"{bridge.place}: {topic} is offered as {offer.reliability}")
    return Finding(True, expected, "so it does")


def _why(recording: Recording, topic: str, depth: Sequence[float]) -> str:
    """Return what was taken for the number of messages that a bridge keeps; empty if nothing was."""
    facts = recording.facts()
    if any("'subscriber_queue' changes" in each["sentence"] for each in facts.get("lint", [])):
        return "subscriber_queue is the queue of a bridge that listens in ROS; this one publishes there"
    if topic in facts.get("lazy", []):
        return "lazy opens a bridge only while somebody listens; it says nothing about how many messages are kept"
    for other in bridges(recording):
        if other.ros_topic != topic and other.publisher_qos and depth[0] <= other.publisher_qos.depth <= depth[1]:
            return f"{other.place}: {other.ros_topic} sets this; the task asks for it at {topic}"
    return ""
