"""Faults in what a node publishes and subscribes to, by its endpoints and the messages that came."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gz_course.grader.feedback.recorded.places import stands_before
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.sim.did_you_mean import nearest_name

# Topics of every ROS 2 node, which say nothing about the exercise.
OWN_TOPICS = frozenset({"/rosout", "/parameter_events", "/clock"})
LOST = "before anybody has found the publisher"  # words of a check's explanation that says so itself


def ends_of(facts: dict[str, Any], kind: str) -> list[dict[str, str]]:
    return [e for e in facts.get("endpoints", []) if e["kind"] == kind and e["topic"] not in OWN_TOPICS]


def publishers(recording: Recording, facts: dict[str, Any]) -> str:
    """Name the first topic that is not published as it should be, and what is published instead."""
    published = ends_of(facts, "publisher")
    topics = {e["topic"] for e in published}
    for topic, kind in facts.get("listened", {}).items():
        mine = [e for e in published if e["topic"] == topic]
        if any(e["type"] == kind and e["reliability"] != "BEST_EFFORT" for e in mine):
            continue
        if any(e["type"] == kind for e in mine):
            return (
                f"Your publisher on {topic} has the reliability BEST_EFFORT; the bridge's subscription is RELIABLE, so "
                "nothing arrives. Use the default QoS (a depth of 10)."
            )
        if mine:
            return f"{topic} is published as {mine[0]['type']}, but {kind} is expected; DDS connects equal types only."
        twins = [e["topic"] for e in published if e["type"] == kind]
        if near := nearest_name(topic, topics) or next(iter(twins), ""):
            why = _why(topic, near, [e["node"] for e in published if e["topic"] == near])
            return f"Nothing is published on {topic}; your node publishes on {near} instead.{why}"
        listens = any(e["topic"] == topic for e in ends_of(facts, "subscription"))
        instead = ", but a subscription, which listens: create_publisher() makes a publisher" if listens else ""
        return f"Your node has no publisher on {topic} ({kind}){instead}."
    return ""


def subscriptions(recording: Recording, facts: dict[str, Any]) -> str:
    """Name the first subscription that cannot receive anything."""
    offered: dict[str, str] = facts.get("offered", {})
    own = {e["topic"] for e in ends_of(facts, "publisher")}
    for e in ends_of(facts, "subscription"):
        kind = offered.get(e["topic"])
        if kind is None and e["topic"] in own:
            continue
        if kind is None:
            near = nearest_name(e["topic"], offered, 0.3)
            near = near or next((topic for topic, offer in offered.items() if offer == e["type"]), "")
            hint = f"; did you mean '{near}'?" if near else ""
            why = _why(near, e["topic"], [e["node"]]) if near else ""
            return f"Your node subscribes to {e['topic']}, where nobody publishes{hint}{why}"
        if kind != e["type"]:
            return f"Your node subscribes to {e['topic']} as {e['type']}, but it carries {kind}."
        if e["reliability"] == "RELIABLE" and e["topic"] in facts.get("offered_best_effort", []):
            return (
                f"Your subscription to {e['topic']} asks for the reliability RELIABLE, but the bridge offers "
                "BEST_EFFORT there, as drivers of sensors do: it gets nothing. Use qos_profile_sensor_data."
            )
        if e["durability"] == "TRANSIENT_LOCAL" and e["topic"] not in facts.get("kept", []):
            return (
                f"Your subscription to {e['topic']} asks for the durability TRANSIENT_LOCAL, which the bridge does not "
                "offer: it gets nothing. Use the default, VOLATILE."
            )
    return ""


def _why(wanted: str, used: str, nodes: list[str]) -> str:
    """Explain a topic's name: ROS puts names that do not begin with a slash into a namespace."""
    for node in nodes:
        namespace = node.rpartition("/")[0]
        if used == node + wanted:
            return f" The ~ in its name stands for {node}: leave it out."
        if namespace and used == namespace + wanted:
            return (
                f" Your node lives in the namespace {namespace}, and a name that does not begin with a slash is put "
                f"into it: write {wanted}."
            )
    if used != wanted and used.startswith(("/model/", "/world/")) and used.endswith(wanted):
        return f" On the ROS side it is called {wanted}: topics of ROS and of Gazebo may have different names."
    return ""


def silent(recording: Recording, facts: dict[str, Any]) -> str:
    """Name the first topic with a publisher and no message."""
    for topic in facts.get("listened", {}):
        if not recording.has(f"topics/{topic.strip('/')}/count"):
            if early := _too_early(facts, topic):
                return early
            if facts.get("exit_at") is not None:
                return (
                    f"Your node's process ended (exit code 0) at {facts['exit_at']:.2f} s of simulated time, before it "
                    f"had published anything on {topic}. rclpy.spin(node) keeps a node alive; rclpy.spin_once(node) "
                    "waits for one event only."
                )
            said = f"Your node has a publisher on {topic} but never published a message{_unheard(facts)}."
            return f"{said} {stands_before(facts, topic)}".strip()
    return ""


def _unheard(facts: dict[str, Any]) -> str:
    """Return the end of a sentence on why a node publishes nothing, as far as its subscriptions tell."""
    own = {(e["topic"], e["node"]) for e in ends_of(facts, "publisher")}
    for e in ends_of(facts, "subscription"):
        others = {node for topic, node in own if topic == e["topic"]} - {e["node"]}
        if (e["topic"], e["node"]) in own and not others and e["topic"] not in facts.get("offered", {}):
            return f": it subscribes to {e['topic']} itself, where nobody else publishes, so that callback never runs"
    heard = [e["topic"] for e in ends_of(facts, "subscription") if e["topic"] in facts.get("offered", {})]
    if not heard:
        return ""
    if caught := next((each for each in facts.get("suspects", []) if each["about"] == "hidden"), None):
        return f", although it hears {heard[0]}: line {caught['line']}: {caught['said']}"
    return (
        f", although it hears {heard[0]}: a condition before publish() never holds, or an error is caught, such as "
        "that of a transform between frames that do not exist"
    )


def _too_early(facts: dict[str, Any], topic: str) -> str:
    """Return a sentence about messages that were published before anybody had found the publisher; else nothing."""
    count = facts.get("too_early", {}).get(topic, 0)
    if not count:
        return ""
    what, pronoun = ("1 message", "it was") if count == 1 else (f"{count} messages", "they were")
    mine = [each for each in ends_of(facts, "publisher") if each["topic"] == topic]
    kept = ""
    if any(each.get("durability") == "TRANSIENT_LOCAL" for each in mine):
        kept = " TRANSIENT_LOCAL keeps messages only for listeners that ask for it, too, and few do."
    return (
        f"{what} on {topic} {'was' if count == 1 else 'were'} published before anybody had found the publisher, so "
        f"{pronoun} lost: others find it while your node waits.{kept} Publish from a timer, or wait until "
        "get_subscription_count() is not 0."
    )


def too_early(recording: Recording, findings: Iterable[Finding]) -> str:
    """Return a sentence about the first topic with messages that were published too early; empty if there is none."""
    facts = recording.facts()
    if any(LOST in finding.explanation for finding in findings):
        return ""
    return next(filter(None, (_too_early(facts, topic) for topic in facts.get("listened", {}))), "")
