"""A submission that is still the starter: nothing in it can be wrong, and the report says where to begin."""

from __future__ import annotations

import re
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.pristine import pristine
from gz_course.grader.printable import shown

PART = re.compile(r"^\s*#\s*(?:Your part|Part 1): *(.*)$")
COMMENT = re.compile(r"^\s*#\s?(.*)$")
MOST_WORDS = 19  # of the part that is quoted


def untouched(exercise: Exercise, main: str, files: dict[str, bytes]) -> str:
    """Return where to begin, one sentence, if every file of a submission is as it was handed out; else nothing."""
    try:
        starter = pristine(exercise)
    except UsageError:  # nobody knows what was handed out
        return ""
    given = files | {exercise.file: files.get(main, b"")}
    if any(given.get(name) != content for name, content in starter.items()):
        return ""
    for name in exercise.parts:
        if part := _first_part(starter[name]):
            line, text = part
            return shown(f"{Path(name).name} is as it was handed out. Begin at line {line}: {text}")
    return f"{exercise.file} is as it was handed out. Begin with the task, exercises/{exercise.name}/README.md."


def _first_part(content: bytes) -> tuple[int, str] | None:
    """Return the line of the first part to fill in, and what it asks for."""
    lines = content.decode(errors="replace").splitlines()
    for number, line in enumerate(lines):
        if match := PART.match(line):
            words = match[1].split()
            for further in lines[number + 1 :]:
                if (more := COMMENT.match(further)) is None:
                    break
                words += more[1].split()
            return number + 1, _beginning(words)
    return None


def _beginning(words: list[str]) -> str:
    """Return so many words at most, up to the end of a clause where there is one."""
    kept = words[:MOST_WORDS]
    if len(words) > MOST_WORDS:
        ends = [[n for n, word in enumerate(kept, 1) if word.endswith(marks)] for marks in ((".", ";"), (",",))]
        end = next((places[-1] for places in ends if places), None)
        if end is None:
            return " ".join(kept) + " ..."
        kept = kept[:end]
    return " ".join(kept).rstrip(".,;:") + "."
