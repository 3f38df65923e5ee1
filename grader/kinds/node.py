"""`kind = "node"`: the submission is a Python file with an rclpy node; the exercise's bridge joins it to the robot."""

from __future__ import annotations

import codecs
import io
import re
import tokenize
import warnings
from typing import TYPE_CHECKING

from gz_course.grader.kinds.kind import Cast, Kind
from gz_course.grader.lint.wall_clock import wall_clock
from gz_course.grader.lint.whole_numbers import float_fields, whole_numbers
from gz_course.grader.printable import shown

if TYPE_CHECKING:
    from gz_course.grader.exercise import Exercise
    from gz_course.grader.submission import Submission


def fault(name: str, content: bytes) -> str | None:
    """Say why a file is not Python, with its line."""
    if unreadable := _not_a_text(name, content):
        return shown(unreadable)
    try:
        # compile() passes bytes in a comment that are not UTF-8; Python, which is given the file, does not.
        content.decode(tokenize.detect_encoding(io.BytesIO(content).readline)[0])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an odd escape in a student's string is not our business
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
    """Say which other encoding a file is in, where Python's own words do not."""
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return f"{name} is saved as UTF-16, which Python does not read: save it as UTF-8"
    head = content.splitlines()[:2]
    if any(re.match(rb"[ \t\f]*#.*?coding[:=]", line) for line in head):
        return ""  # it says itself how it is written
    try:
        content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        place = content[: error.start].count(b"\n") + 1
        return f"{name}, line {place}: this is not UTF-8: byte 0x{content[error.start]:02x}; save the file as UTF-8"
    return ""


def cast(exercise: Exercise, submission: Submission) -> Cast:
    """The student's node, and the bridge of the exercise."""
    from gz_course.grader.run.exercise_bridge import exercise_bridge

    entries, content = exercise_bridge(exercise), submission.files[submission.main]
    heard = {e.ros_type for e in entries if e.direction.to_gz} | set(exercise.observe.values())
    places = {
        "wall_clock": wall_clock(content),
        "whole_numbers": whole_numbers(content, float_fields(heard)),
    }
    facts = {
        name: [{"file": shown(submission.main)} | place for place in found] for name, found in places.items() if found
    }
    return Cast(submission.main, submission.files, entries, facts)


KIND = Kind((".py",), fault, cast)
