"""Explanations of a message too many, or of one too late, that name the line: a counter, or a publish() too early."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from gz_course.grader.feedback.predictions.texts import asked_for
from gz_course.grader.feedback.rules import guarded
from gz_course.grader.record.reading import Recording

TICK = 0.01  # [s]
MANY = 50  # messages, as only a callback that calls itself sends them
NEAR = 0.06  # of a time: as far as a message may come from when a counter would send it


@guarded("")
def counted_late(recording: Recording, times: np.ndarray, window: tuple[float, float]) -> str:
    """Return which counter is compared before it is increased, if that makes a message as late as it came."""
    first, middle = float(times[0]), asked_for(window)
    if first <= window[1]:
        return ""
    for place in recording.facts().get("counters", []):
        limit = place["limit"]
        if limit < 1 or abs(first - middle * (limit + 1) / limit) > NEAR * first:
            continue
        return (
            f"{place['file']}, line {place['line']}: {place['code']} is looked at before line {place['added']} adds 1: "
            f"{place['counter']} is still 0 in the first call, so this holds one call too late, after {first:.2f} s: "
            "add first"
        )
    return ""


@guarded("")
def added_up(recording: Recording, times: np.ndarray, window: tuple[float, float]) -> str:
    """Return which timers and sleeps make the time at which the first message came; empty if they do not."""
    first, found = float(times[0]), recording.facts().get("delays", [])
    middle = asked_for(window)
    if not found or window[0] <= first <= window[1] or first < 2 * TICK:
        return ""
    file = f"{found[0]['file']}, line {found[0]['line']}"
    for number in range(1, len(found) + 1):  # what stands below publish() delays nothing
        if abs(first - sum(each["seconds"] * each["rounds"] for each in found[:number])) <= NEAR * first:
            parts = " and ".join(_part(each, found[0]) for each in found[:number])
            return f"{file}: {parts}, so the message comes after {first:.2f} s in place of {middle:g} s"
    timers = [each for each in found if each["kind"] == "timer"]
    if len(found) == len(timers) == 1 and timers[0]["seconds"] > 0:
        calls = round(first / timers[0]["seconds"])
        if calls > 1 and abs(first - calls * timers[0]["seconds"]) <= 2 * TICK:
            return (
                f"{file}: this timer calls every {timers[0]['seconds']:g} s, and the message came in call {calls}, "
                f"after {first:.2f} s in place of {middle:g} s"
            )
    return ""


def _part(delay: dict[str, Any], first: dict[str, Any]) -> str:
    """Return one of the delays that are added up, the first of a sentence without its line."""
    where = "" if delay is first else f" in line {delay['line']}"
    if delay["kind"] == "timer":
        return f"the timer{where} waits {delay['seconds']:g} s before its first call"
    again = f" {delay['rounds']} times" if delay["rounds"] > 1 else ""
    return f"the sleep{where} takes {delay['seconds']:g} s{again}"


@guarded("")
def counted_too_far(recording: Recording, times: np.ndarray) -> str:
    """Return which counter lets one message too many through, if it makes as many as arrived."""
    for place in recording.facts().get("counters", []):
        if len(times) == place["limit"] + 1 and re.search(r"> |<= ", place["code"]):
            return (
                f"{place['file']}, line {place['line']}: {place['code']} looks at {place['counter']} before line "
                f"{place['added']} adds 1, so it is 0 at the first message and {len(times) - 1} at the last: "
                f"{len(times)} messages are sent"
            )
    return ""


@guarded("")
def sent_again(recording: Recording) -> str:
    """Return which timer there is more than once, or which loop publishes; empty if there is none."""
    for place in recording.facts().get("repetitions", []):
        return f"{place['file']}, line {place['line']}: {place['said']}"
    return ""


@guarded("")
def answers_itself(recording: Recording, topic: str, times: np.ndarray) -> str:
    """Return that a node hears its own messages and sends another for each; empty if it does not."""
    ends = [each for each in recording.facts().get("endpoints", []) if each["topic"] == topic]
    hears = {each["node"] for each in ends if each["kind"] == "subscription"}
    speaks = {each["node"] for each in ends if each["kind"] == "publisher"}
    if len(times) < MANY or not hears & speaks:
        return ""
    return (
        f"your node subscribes to {topic}, where it publishes itself: its callback hears each of its own messages and "
        "sends another one"
    )


@guarded("")
def sent_too_early(recording: Recording) -> str:
    """Return where a message is sent before others have found the publisher; empty if that is unknown."""
    for place in recording.facts().get("early_publishing", []):
        where = f" in {place['function']}" if place["function"] else ""
        return (
            f"{place['file']}, line {place['line']}: what is published here{where} is sent before anybody has found "
            "the publisher, so it is lost, but it was sent, and counts: leave it out. Others find a publisher while "
            "the node waits, without a message"
        )
    return ""
