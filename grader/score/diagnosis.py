"""Names the fault behind a failed run, in the order in which one would look for it.

Works from the facts in the recording: which endpoints the node had, how its process ended, what was dropped.
"""

from __future__ import annotations

from difflib import get_close_matches
from typing import Any

from grader.record.reading import Recording

# Every ROS 2 node has these; they say nothing about the exercise.
OWN_TOPICS = frozenset({"/rosout", "/parameter_events", "/clock"})


def outcome_of(recording: Recording) -> str:
    """Return `graded`, `student_error` (it could not run, or it crashed) or `timeout` (it never spun)."""
    facts = recording.facts()
    if facts.get("fault") or facts.get("exit_code") not in (None, 0):
        return "student_error"
    if not facts.get("ready", True):
        return "timeout" if facts.get("exit_at") is None else "student_error"
    return "graded"


def diagnose(recording: Recording) -> str:
    """Return one sentence on the first fault found, or an empty string if nothing structural is wrong."""
    facts = recording.facts()
    for look in (
        _cannot_run,
        _died,
        _ended_early,
        _never_spun,
        _publishers,
        _subscriptions,
        _silent,
        _dropped,
        _unstable,
    ):
        if sentence := look(recording, facts):
            return sentence
    return ""


def _cannot_run(recording: Recording, facts: dict[str, Any]) -> str:
    return str(facts["fault"]) if facts.get("fault") else ""


def _died(recording: Recording, facts: dict[str, Any]) -> str:
    code = facts.get("exit_code")
    if code in (None, 0):
        return ""
    lines = [line.text for line in recording.lines("log/student")]
    how = f"was killed by signal {-code}" if code < 0 else f"ended with exit code {code}"
    starts = [i for i, line in enumerate(lines) if line.startswith("Traceback (most recent call last)")]
    if starts:
        trace = lines[starts[-1] :]
        place = next((line.strip() for line in reversed(trace) if line.strip().startswith("File ")), "")
        error = next((line for line in reversed(trace) if line and not line.startswith(" ")), "")
        return f"Your node died at {facts['exit_at']:.2f} s of simulated time with {error} ({_place(place)})."
    return f"Your node's process {how} at {facts['exit_at']:.2f} s of simulated time, before the exercise was over."


def _place(line: str) -> str:
    """Shorten `File "/a/b/node.py", line 7, in main` to `node.py, line 7`."""
    parts = line.split(", ")
    if len(parts) < 2:
        return "no line known"
    return f"{parts[0].split('/')[-1].strip(chr(34))}, {parts[1]}"


def _ended_early(recording: Recording, facts: dict[str, Any]) -> str:
    if facts.get("ready", True) or facts.get("exit_at") is None:
        return ""
    return (
        "Your node's process ended (exit code 0) before simulated time began: nothing kept it alive. "
        "Create the node and hand it to rclpy.spin()."
    )


def _never_spun(recording: Recording, facts: dict[str, Any]) -> str:
    if facts.get("ready", True):
        return ""
    return "Your node's process ran but never spun: no timer and no callback can run before rclpy.spin(node) is called."


def _of(facts: dict[str, Any], kind: str) -> list[dict[str, str]]:
    return [e for e in facts.get("endpoints", []) if e["kind"] == kind and e["topic"] not in OWN_TOPICS]


def _publishers(recording: Recording, facts: dict[str, Any]) -> str:
    published = _of(facts, "publisher")
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
        if near := get_close_matches(topic, topics, n=1, cutoff=0.6) or twins:
            return f"Nothing is published on {topic}; your node publishes on {near[0]} instead."
        return f"Your node has no publisher on {topic} ({kind})."
    return ""


def _subscriptions(recording: Recording, facts: dict[str, Any]) -> str:
    offered: dict[str, str] = facts.get("offered", {})
    for e in _of(facts, "subscription"):
        kind = offered.get(e["topic"])
        if kind is None:
            near = get_close_matches(e["topic"], offered, n=1, cutoff=0.3)
            near = near or [topic for topic, offer in offered.items() if offer == e["type"]]
            hint = f"; did you mean {near[0]}?" if near else ""
            return f"Your node subscribes to {e['topic']}, where nobody publishes{hint}"
        if kind != e["type"]:
            return f"Your node subscribes to {e['topic']} as {e['type']}, but it carries {kind}."
        if e["durability"] == "TRANSIENT_LOCAL":
            return (
                f"Your subscription to {e['topic']} asks for the durability TRANSIENT_LOCAL, which the bridge does not "
                "offer: it gets nothing. Use the default, VOLATILE."
            )
    return ""


def _silent(recording: Recording, facts: dict[str, Any]) -> str:
    for topic in facts.get("listened", {}):
        if not recording.has(f"topics/{topic.strip('/')}/count"):
            return f"Your node has a publisher on {topic} but never published a message."
    return ""


def _dropped(recording: Recording, facts: dict[str, Any]) -> str:
    for topic, count in facts.get("dropped", {}).items():
        return (
            f"{count} messages on {topic} were dropped because they held NaN or infinite numbers; "
            "the robot never saw them."
        )
    return ""


def _unstable(recording: Recording, facts: dict[str, Any]) -> str:
    return f"The simulation ended early: {facts['unstable']}" if facts.get("unstable") else ""
