"""What a traceback tells: the error, the student's line that led to it, and what to change there.

Source: the form of tracebacks of CPython 3.11.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from gz_course.grader.feedback.errors.python_errors import meaning
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding

FRAME = re.compile(r'\s+File "(.*)", line (\d+)')
INSTALLED = ("/site-packages/", "/lib/python3", "/sim/", "/gz_course/", "<")  # parts of paths of installed code
COMMENT = re.compile(r"\s+#[^'\"]*$")
LONGEST_CODE = 70  # characters of the student's line that are quoted

# Errors of a node that is told to end.
AT_THE_END = ("KeyboardInterrupt", "SystemExit", "rclpy.executors.ExternalShutdown", "rclpy._rclpy_pybind11.RCLError")


@dataclass(frozen=True)
class Crash:
    """An error with the student's line: its `file`, `line` and `code`. `own`: the error was raised in that line."""

    error: str
    file: str = ""
    line: str = ""
    code: str = ""
    own: bool = False

    @property
    def place(self) -> str:
        if not self.file:
            return ""
        code = COMMENT.sub("", self.code)
        return f"{self.file}, line {self.line}{f': {shown(code, LONGEST_CODE)}' if code else ''}"

    @property
    def meaning(self) -> str:
        """What to change; empty if it is not known."""
        return meaning(self.error, self.code if self.own else "")


def survived(recording: Recording, findings: Iterable[Finding] = ()) -> str:
    """Return a sentence about the last error after which a node went on, as an action server does; empty if none."""
    if recording.facts().get("exit_code") not in (None, 0):
        return ""
    lines = [line.text for line in recording.lines("log/student")]
    crash = read_crash(lines, str(recording.properties("run").get("submission")))
    if crash is None or crash.error.startswith(AT_THE_END):
        return ""
    advice = f" What that means: {crash.meaning}." if crash.meaning else ""
    return shown(f"An error was caught, and your node went on: {crash.error} ({crash.place}).") + shown(advice)


def read_crash(lines: Sequence[str], file: str = "") -> Crash | None:
    """Return the last crash that the output of a program tells; None if there is none.

    The place is in the file of this name; without a name, or where it is not in there, in code that is not installed.
    """
    starts = [i for i, line in enumerate(lines) if line.startswith(("Traceback (most recent", '  File "'))]
    if not starts:
        return None
    # The last block that begins a traceback; a syntax error found at run time has no first line.
    begin = max((i for i in starts if lines[i].startswith("Traceback")), default=starts[0])
    frames: list[tuple[str, str, str]] = []
    for i, line in enumerate(lines[begin:], begin):
        if match := FRAME.match(line):
            after = lines[i + 1] if i + 1 < len(lines) else ""
            code = after.strip() if after.startswith("    ") and not FRAME.match(after) else ""
            frames.append((match[1], match[2], code))
        elif line and not line.startswith((" ", "Traceback")):
            return _crash(line, frames, file)
    return None


def _crash(error: str, frames: list[tuple[str, str, str]], file: str) -> Crash:
    named = [frame for frame in frames if file and frame[0].rpartition("/")[2] == file]
    # rclpy has files of common names, too, such as node.py.
    mine = _of_the_student(named) or named or _of_the_student(frames) or frames
    if not mine:
        return Crash(error)
    path, line, code = mine[-1]
    return Crash(error, path.rpartition("/")[2], line, code, own=mine[-1] is frames[-1])


def _of_the_student(frames: list[tuple[str, str, str]]) -> list[tuple[str, str, str]]:
    return [frame for frame in frames if not any(part in frame[0] for part in INSTALLED)]
