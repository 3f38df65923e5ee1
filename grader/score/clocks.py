"""Detection of a node that did the right thing at the wrong time because it reads another clock than /clock."""

from __future__ import annotations

import re
from collections.abc import Iterable

from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.grader.score.launched import launch_facts

LINE = re.compile(r"\bline (\d+)")  # a line that an explanation names
# Fault of the fact `time_reckoning` -> what is wrong with it.
RECKONED = {
    "ticks": "your node counts ticks; a timer can miss some, so ask the node's clock, self.get_clock().now(), how much "
    "time has passed",
    "restart": "this sets the start again in every call, so the time since then stays 0; set it once, if it is None",
    "nanosec": "these are the nanoseconds within the current second, without the whole seconds; a time in seconds is "
    "sec + nanosec / 1e9, or time.nanoseconds / 1e9",
    "sec": "these are the whole seconds only, without the fraction; a time in seconds is sec + nanosec / 1e9, or "
    "time.nanoseconds / 1e9",
}


def clock_fault(recording: Recording, findings: Iterable[Finding]) -> str:
    """Return one sentence about the clock a node reads; empty if no check failed because of time.

    The evidence: the places in the file that read the wall clock (the fact `wall_clock`), that count ticks or take a
    part of a time for the whole (`time_reckoning`), and the nodes that never subscribed to /clock, as a node does that
    uses simulated time.
    """
    findings = list(findings)
    if not any(finding.timing and not finding.passed and not finding.gated for finding in findings):
        return ""
    facts = recording.facts()
    named = {int(line) for finding in findings for line in LINE.findall(finding.explanation)}
    for place in facts.get("wall_clock", []):
        if place["waits"] and place["line"] in named:
            continue
        where = f"{place['file']}, line {place['line']}"
        if place["waits"]:
            sentence = f"{where}: {place['call']} waits by the wall clock, but time is simulated here: use a timer"
        else:
            sentence = (
                f"{where}: {place['call']} reads the wall clock, but time is simulated here: read the node's own "
                "clock, self.get_clock().now()"
            )
        return shown(f"{sentence}.")
    for place in facts.get("time_reckoning", []):
        if place["line"] in named:
            continue
        return shown(f"{place['file']}, line {place['line']}: {place['code']}: {RECKONED[place['fault']]}.")
    endpoints = facts.get("endpoints", [])
    follows = {e["node"] for e in endpoints if e["kind"] == "subscription" and e["topic"] == "/clock"}
    # bridges do not need the time
    bridges = {each["node"] for each in launch_facts(recording).get("bridges_started", [])}
    for node in sorted({e["node"] for e in endpoints} - follows - bridges):
        return shown(
            f"Your node {node} does not follow simulated time: its parameter use_sim_time is not true, so its clock "
            "and its timers follow the wall clock. Call rclpy.init() without arguments of your own, and leave "
            "use_sim_time as it was given."
        )
    return ""
