"""`kind = "node"`: the submission is a Python file with an rclpy node; the exercise's bridge serves it."""

from __future__ import annotations

import codecs
import io
import re
import tokenize
import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from gz_course.grader.feedback.facts.clocks import time_reckoning, wall_clock
from gz_course.grader.feedback.facts.logs import seldom_log, silent_log
from gz_course.grader.feedback.facts.origins import before_speeds, conditions, of_the_drive, origins
from gz_course.grader.feedback.facts.own_ends import own_ends
from gz_course.grader.feedback.facts.publishing import counters, delays, early_publishing, repetitions
from gz_course.grader.feedback.facts.rhythm import rhythm
from gz_course.grader.feedback.facts.syntax import called, parsed
from gz_course.grader.feedback.facts.whole_numbers import whole_numbers
from gz_course.grader.feedback.rules import as_facts, faults_kept
from gz_course.grader.feedback.slips import slips
from gz_course.grader.feedback.slips.nodes.transforms import lookups, shared_headers
from gz_course.grader.feedback.suspects import suspects
from gz_course.grader.feedback.suspects.steering.feedback import MEANS
from gz_course.grader.kinds.kind import Kind, RunPlan
from gz_course.grader.kinds.programs import node_command
from gz_course.grader.printable import shown

if TYPE_CHECKING:
    from gz_course.grader.exercise import Exercise
    from gz_course.grader.run.run_loop import RunLoop
    from gz_course.grader.score.diagnosis import Diagnosis
    from gz_course.grader.submission import Submission
    from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry

# Functions of numbers and of lists: without them a file cannot hold some mistakes that fit a recording.
OF_VALUES = frozenset({"cos", "sin", "min", "max", "nanmax", "argmax", "sum", "sorted", "sort", "percentile"}) | MEANS


def fault(name: str, content: bytes) -> str | None:
    """Return why a file is not valid Python, with its line, or None."""
    if unreadable := _not_a_text(name, content):
        return shown(unreadable)
    try:
        # compile() accepts bytes in a comment that are not UTF-8; the interpreter reading the same file does not.
        content.decode(tokenize.detect_encoding(io.BytesIO(content).readline)[0])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an invalid escape in a student's string is only a warning
            compile(content, name, "exec", dont_inherit=True)
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        return shown(f"{name}, line {line}: this is not {error.encoding}: byte 0x{content[error.start]:02x}")
    except SyntaxError as error:
        line_number = f"{name}, line {error.lineno}" if error.lineno else name
        code = f": {error.text.strip()}" if error.text and error.text.strip() else ""
        return shown(f"{line_number}: {type(error).__name__}: {error.msg}{code}")
    except (ValueError, RecursionError, MemoryError, LookupError) as error:
        return shown(f"{name} cannot be read as Python: {type(error).__name__}: {error}")
    return None


def _not_a_text(name: str, content: bytes) -> str:
    """Return which other encoding a file has, where Python's own message does not say so."""
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return f"{name} is saved as UTF-16, which Python does not read: save it as UTF-8"
    head = content.splitlines()[:2]
    if any(re.match(rb"[ \t\f]*#.*?coding[:=]", line) for line in head):
        return ""  # its encoding declaration says it
    try:
        content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        place = content[: error.start].count(b"\n") + 1
        return f"{name}, line {place}: this is not UTF-8: byte 0x{content[error.start]:02x}; save the file as UTF-8"
    return ""


def plan(exercise: Exercise, submission: Submission) -> RunPlan:
    """Run the student's node beside the exercise's bridge; record suspicious places in the file as facts."""
    from gz_course.grader.run.exercise_bridge import exercise_bridge

    entries = exercise_bridge(exercise)

    def read() -> dict[str, Any]:
        content = submission.files[submission.main]
        with faults_kept() as faults:
            places = _places(exercise, entries, content) if submission.explained else {}
        file = {"file": shown(submission.main)}
        facts = {name: [file | place for place in found] for name, found in places.items() if found}
        return facts | as_facts(faults)

    return RunPlan(submission.main, submission.files, entries, read, exercise.bridge_parameters)


def _places(exercise: Exercise, entries: Sequence[BridgeEntry], content: bytes) -> dict[str, list[dict[str, Any]]]:
    """Return what feedback finds in the file, by kind."""
    from gz_course.grader.run.message_fields import float_fields, message_fields

    heard = {e.ros_type for e in entries if e.direction.to_gz} | set(exercise.observe.values())
    names = sorted({name for trial in exercise.trials for name in trial.parameters})
    return {
        "before_speeds": before_speeds(content),
        "called": [{"name": name} for name in sorted(called(parsed(content)) & OF_VALUES)],
        "conditions": conditions(content),
        "counters": counters(content),
        "delays": delays(content),
        "early_publishing": early_publishing(content),
        "origins": origins(content),
        "own_ends": own_ends(content),
        "of_the_drive": of_the_drive(content),
        "repetitions": repetitions(content),
        "lookups": lookups(content),
        "shared_headers": shared_headers(content),
        "rhythm": rhythm(content),
        "seldom_log": seldom_log(content),
        "silent_log": silent_log(content),
        "slips": slips(content, exercise.duration, message_fields(heard), names),
        "suspects": suspects(content),
        "time_reckoning": time_reckoning(content),
        "wall_clock": wall_clock(content),
        "whole_numbers": whole_numbers(content, float_fields(heard)),
    }


def run_loop() -> type[RunLoop]:
    """Import the class that simulates such a run, which needs rclpy and MuJoCo."""
    from gz_course.grader.run.run_loop import RunLoop

    return RunLoop


def diagnosis() -> Diagnosis:
    """Explain runs by the student's node: possible faults in the order in which one would look for them."""
    from gz_course.grader.score import diagnosis as looks
    from gz_course.grader.score import topic_faults
    from gz_course.grader.score.clocks import clock_fault
    from gz_course.grader.score.crash import survived
    from gz_course.grader.score.lost_numbers import lost_number
    from gz_course.grader.score.parameters_set import parameter_not_set
    from gz_course.grader.score.services_called import service_without_answer

    return looks.Diagnosis(
        looks.outcome_of,
        (
            looks.tampered,
            looks.cannot_run,
            looks.broke_a_limit,
            looks.slip,
            looks.died,
            looks.ended_early,
            looks.never_spun,
            looks.out_of_time,
            topic_faults.publishers,
            topic_faults.subscriptions,
            topic_faults.silent,
            looks.dropped,
            parameter_not_set,
            service_without_answer,
            looks.unstable,
        ),
        (looks.slips, survived, looks.whole_number_fault, lost_number, clock_fault, topic_faults.too_early),
    )


KIND = Kind((".py",), fault, plan, node_command, run_loop, diagnosis)
