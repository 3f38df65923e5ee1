"""The faults behind failed runs: each function recognises one. Each kind of submission has its own order of them.

The evidence are the facts in the recording: the node's endpoints, how its process ended, what was dropped.
"""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from gz_course.grader.feedback.errors.python_errors import meaning
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.grader.score.crash import read_crash
from gz_course.grader.score.launched import launch_fault
from gz_course.grader.score.topic_faults import ends_of, publishers, silent, too_early

# What a program did that was ended for breaking a limit.
LIMITS = {
    "memory": "and all it started used more than 2 GiB of memory together",
    "processes": "started more than 128 processes",
    "disk": "wrote more files, or larger ones, than its folder may hold (64 MiB)",
}

STARTED = 0.05  # [s] of simulated time: who ended before that ended before simulated time began


# Returns one sentence about a fault, or an empty string, given a recording and its facts.
Look = Callable[[Recording, dict[str, Any]], str]
Remark = Callable[[Recording, Iterable[Finding]], str]


@dataclass(frozen=True)
class Diagnosis:
    """How a kind of submission explains a recording.

    `outcome` classifies the run. `looks` are asked in turn, until one has found a fault. If none has, `remarks` come
    before the text of the first failed check.
    """

    outcome: Callable[[Recording], str]
    looks: tuple[Look, ...]
    remarks: tuple[Remark, ...] = ()


def outcome_of(recording: Recording) -> str:
    """Return the class of a run.

    `tamper`: it published what only the simulator may; `protocol`: it closed the descriptors it was given; `memory`: it
    ran out of memory; `student_error`: it could not run, or crashed; `timeout`: it never spun, or delayed the run too
    long; `graded`: none of these.
    """
    facts = recording.facts()
    if _reserved(facts):
        return "tamper"
    if facts.get("fault"):
        return str(facts.get("outcome", "student_error"))
    if facts.get("hid"):
        return "protocol"
    if limit := facts.get("limit"):
        return "memory" if limit == "memory" else "student_error"
    if facts.get("exit_code") not in (None, 0):
        memory = any(line.text.startswith("MemoryError") for line in recording.lines("log/student"))
        return "memory" if memory else "student_error"
    if facts.get("out_of_time"):
        return "timeout"
    if not facts.get("ready", True):
        return "timeout" if facts.get("exit_at") is None else "student_error"
    return "graded"


def diagnose(recording: Recording, looks: Iterable[Look]) -> str:
    """Return the first sentence that one of `looks` returns; empty if nothing structural is wrong."""
    facts = recording.facts()
    return next(filter(None, (look(recording, facts) for look in looks)), "")


def whole_number_fault(recording: Recording, findings: Iterable[Finding] = ()) -> str:
    """Return one sentence about a float field that was assigned what is no float; empty if there is none."""
    for place in recording.facts().get("whole_numbers", []):
        kind = f" (it is an {place['type']} of NumPy)" if place.get("type") else ""
        parameter = "get_parameter" in place["value"] or "declare_parameter" in place["value"]
        right = "its .value is the number" if parameter else "write a number with a point, or float(...)"
        return shown(
            f"{place['file']}, line {place['line']}: {place['field']} = {place['value']} is no float{kind}, but the "
            f"field holds one; rclpy does not convert it and sends 0: {right}."
        )
    return ""


def cannot_run(recording: Recording, facts: dict[str, Any]) -> str:
    """Return why the file cannot be run at all."""
    if not facts.get("fault"):
        return ""
    said = meaning(str(facts["fault"]))
    return f"{facts['fault']}. What that means: {said}." if said else str(facts["fault"])


def slip(recording: Recording, facts: dict[str, Any]) -> str:
    """Name the mistake in the file for which the node died, ended, never spun or never spoke; then say that it did."""
    what = next(filter(None, (look(recording, facts) for look in (died, ended_early, never_spun, out_of_time))), "")
    what = what or (silent if ends_of(facts, "publisher") else publishers)(recording, facts)
    return f"{slips(recording)} {what}" if what and facts.get("slips") else ""


def slips(recording: Recording, findings: Iterable[Finding] = ()) -> str:
    """Return one sentence about a mistake in the file that raises no error of its own; empty if there is none."""
    for place in recording.facts().get("slips", []):
        return shown(f"{place['file']}, line {place['line']}: {place['said']}.", 400)
    return ""


def broke_a_limit(recording: Recording, facts: dict[str, Any]) -> str:
    """Name the limit of the sandbox for which the program was ended."""
    limit = facts.get("limit")
    when = f" at {facts['exit_at']:.2f} s of simulated time" if facts.get("exit_at") is not None else ""
    return f"Your program {LIMITS[limit]}; it was ended{when}." if limit in LIMITS else ""


def died(recording: Recording, facts: dict[str, Any]) -> str:
    """Name the error, or the signal, that ended the node's process, with file and line."""
    code = facts.get("exit_code")
    if code in (None, 0):
        return ""
    when = f"at {facts['exit_at']:.2f} s of simulated time"
    if facts.get("hid"):
        return f"Your node's process closed the descriptors it was started with {when}; it was ended and not followed."
    lines = [line.text for line in recording.lines("log/student")]
    crash = read_crash(lines, str(recording.properties("run").get("submission"))) if code > 0 else None
    if crash is not None:
        place = f" ({crash.place})" if crash.place else ""
        advice = shown(f" What that means: {said}.") if (said := crash.meaning) else ""
        return f"{shown(f'Your node died {when} with {crash.error}{place}.')}{advice}"
    how = f"was killed by {_signal_name(-code)}" if code < 0 else f"ended with exit code {code}"
    return f"Your node's process {how} {when}, before the exercise was over."


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


def ended_early(recording: Recording, facts: dict[str, Any]) -> str:
    """Report that nothing kept the node alive until simulated time began."""
    if facts.get("ready", True) or facts.get("exit_at") is None:
        return ""
    when = "before simulated time began"
    if facts["exit_at"] > STARTED:
        when = f"at {facts['exit_at']:.2f} s of simulated time and had never spun"
    return (
        f"Your node's process ended (exit code 0) {when}: nothing kept it alive. "
        f"Create the node and hand it to rclpy.spin(). {too_early(recording, ())}"
    ).strip()


def never_spun(recording: Recording, facts: dict[str, Any]) -> str:
    """Report that the node was never spun."""
    if facts.get("ready", True):
        return ""
    if facts.get("stopped"):
        return "Your node's process was stopped by a signal (such as SIGSTOP) and never went on: nothing runs in it."
    if facts.get("never_at_rest"):
        return (
            "Your node is spun, but its process never comes to rest: beside spinning, or in a callback, it computes "
            "without end, so nobody can tell when it has dealt with a message. Let what loops wait in each round, with "
            "time.sleep() or for an event, or do its work in a timer."
        )
    return "Your node's process ran but never spun: no timer and no callback can run before rclpy.spin(node) is called."


def dropped(recording: Recording, facts: dict[str, Any]) -> str:
    """Report how many messages were not finite."""
    for topic, count in facts.get("dropped", {}).items():
        what = "1 message" if count == 1 else f"{count} messages"
        verb, pronoun = ("was", "it") if count == 1 else ("were", "they")
        return (
            f"{what} on {topic} {verb} dropped because {pronoun} held NaN or infinite numbers; "
            "the robot did not receive them."
        )
    return ""


def unstable(recording: Recording, facts: dict[str, Any]) -> str:
    """Explain why the physics diverged."""
    return f"The simulation ended early: {facts['unstable']}" if facts.get("unstable") else ""


def _reserved(facts: dict[str, Any]) -> list[str]:
    """Return the simulator's own topics on which the node published as well, as DDS discovery has shown."""
    return list(facts.get("reserved", []))


def tampered(recording: Recording, facts: dict[str, Any]) -> str:
    """Name a topic of the simulator on which the node publishes as well."""
    topics = _reserved(facts)
    if not topics:
        return ""
    return (
        f"Your node publishes on {topics[0]}, which belongs to the simulator: nobody but the bridge may publish there."
    )


def out_of_time(recording: Recording, facts: dict[str, Any]) -> str:
    """Report that the node delayed the simulation too long, and when it was ended."""
    if not facts.get("out_of_time"):
        return ""
    if facts.get("flooded"):
        return (
            f"Your nodes sent more than 10000 messages at {facts['sim_seconds']:.2f} s of simulated time, which stands "
            "still until they come to rest; the run was ended. Do two callbacks answer each other at once? Publish "
            "from a timer, or only when something has changed."
        )
    return (
        f"Your node held the simulation up so long that the run was ended at {facts['sim_seconds']:.2f} s of simulated "
        "time: its callbacks take far longer than the time between them."
    )


def launch_failed(recording: Recording, facts: dict[str, Any]) -> str:
    return launch_fault(recording)
