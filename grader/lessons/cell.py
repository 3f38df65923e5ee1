"""A reader's cell is executed: within a time, with so much output, and without harm to the cells after it.

A cell that raises, loops for ever or prints without end is told so in one sentence, and the notebook goes on.
"""

from __future__ import annotations

import ast
import contextlib
import io
import linecache
import os
import re
import signal
import subprocess
import sys
import threading
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType
from typing import Any

from gz_course.grader.lessons.step import COMMANDS, PYTHON, NotYet, Step
from gz_course.grader.process.load import crowded

MOST_OUTPUT = 20_000  # [characters] of a cell that are shown
PLACEHOLDER = re.compile(r"(?<![.\w])\.\.\.(?![.\w])")
UNTOUCHED = "Nothing is written here yet: put your own lines in place of the dots, and run the cell again."
SHELL_LINE = re.compile(r"^\s*(\w+ = )?[!%]", re.MULTILINE)
BANG = re.compile(r"^\s*!", re.MULTILINE)  # before a command, as in other cells of a notebook
AGAIN = 1.0  # [s] between two interrupts of a cell that catches the first
GRACE = 0.5  # [s] from SIGINT to SIGTERM and from there to SIGKILL, for what a command has started
EXTRA = 9  # times that a crowded machine gets the limit anew
LONGEST_LINE = 60  # [characters] of a line that is quoted


class TooLong(BaseException):
    """A cell has computed for longer than its limit; no `except Exception` of it catches this."""


def untouched(body: str, form: str) -> bool:
    """Tell whether a cell still has the dots that its reader should replace."""
    if not body.strip():
        return True
    if form == PYTHON:
        try:
            tree = ast.parse(SHELL_LINE.sub("pass  # ", body))
        except SyntaxError:
            return PLACEHOLDER.search(body) is not None
        indices = {
            id(part) for each in ast.walk(tree) if isinstance(each, ast.Subscript) for part in ast.walk(each.slice)
        }
        return any(isinstance(e, ast.Constant) and e.value is ... and id(e) not in indices for e in ast.walk(tree))
    return PLACEHOLDER.search(body) is not None


def execute(step: Step, body: str, names: dict[str, Any], folder: Path, transform: Callable[[str], str]) -> str:
    """Do what a cell says, in the namespace `names` or the folder; return what it printed.

    `transform` makes Python of a notebook's lines for the shell. Raises NotYet for a cell that is untouched, raises,
    or does not end.
    """
    if untouched(body, step.form):
        raise NotYet(UNTOUCHED)
    if step.form == PYTHON:
        with within(step.limit):
            return _python(step.name, body, names, transform)
    if step.form == COMMANDS:
        output = run_commands(BANG.sub("", body), folder, step.limit / 3)
        sys.stdout.write(output)
        return output
    (folder / step.form).write_text(body if body.endswith("\n") else body + "\n", encoding="utf-8")
    return ""


def run_commands(script: str, folder: Path, deadline: float) -> str:
    """Return what the lines of a shell print. What they started is ended with them.

    Raises NotYet if they do not end within `deadline` [s], which begins anew on a crowded machine, up to `EXTRA` times.
    """
    process = subprocess.Popen(
        ["/bin/bash", "-c", script],
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        start_new_session=True,
    )
    try:
        output = _output(process, deadline)
    finally:
        for ending in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, ending)
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.communicate(timeout=GRACE)
                if not _group_lives(process.pid):
                    break
    return shortened(output.decode(errors="replace"))


def _output(process: subprocess.Popen[bytes], deadline: float) -> bytes:
    for left in range(EXTRA, -1, -1):
        try:
            return process.communicate(timeout=deadline)[0]
        except subprocess.TimeoutExpired:
            if not (left and crowded()):
                break
    raise NotYet(
        f"The command had not ended after {deadline:g} s. Ask it to end by itself, "
        "for example with --once, --times or -n."
    )


def shortened(text: str) -> str:
    """Return what is shown of a long output."""
    rest = len(text) - MOST_OUTPUT
    return text if rest <= 0 else f"{text[:MOST_OUTPUT]}\n... and {rest:,} more characters\n"


def _group_lives(group: int) -> bool:
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


def _python(name: str, body: str, names: dict[str, Any], transform: Callable[[str], str]) -> str:
    file = f"<step {name}>"
    linecache.cache[file] = (len(body), None, body.splitlines(keepends=True), file)
    printed = Printed(sys.stdout)
    with own_words(file), contextlib.redirect_stdout(printed):
        try:
            tree = ast.parse(transform(body), file)
            shown = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
            exec(compile(tree, file, "exec"), names)
            if isinstance(shown, ast.Expr):
                sys.displayhook(eval(compile(ast.Expression(shown.value), file, "eval"), names))
        finally:
            printed.end()
    return printed.text


@contextlib.contextmanager
def own_words(file: str) -> Iterator[None]:
    """Turn whatever the reader's code in this file raises into NotYet, with the line that raised it."""
    try:
        yield
    except NotYet:
        raise
    except SyntaxError as error:
        raise NotYet(f"Line {error.lineno} is no Python: {error.msg}.") from None
    except SystemExit:
        raise NotYet(
            "The cell ends the program (SystemExit); a cell of a notebook just comes to its last line."
        ) from None
    except Exception as error:
        frames = [each for each in traceback.extract_tb(error.__traceback__) if each.filename == file]
        text = "".join(traceback.format_exception_only(error)).strip().partition("\n")[0]
        where = ""
        if frames:
            line = (frames[-1].line or "").strip()
            where = f"Line {frames[-1].lineno}, `{line[:LONGEST_LINE]}`, raises "
        raise NotYet(f"{where}{text.rstrip('.')}.") from None


@contextlib.contextmanager
def within(seconds: float) -> Iterator[None]:
    """End what the main thread does here after this time; elsewhere there is no limit. Raises NotYet.

    On a crowded machine the time begins anew, up to `EXTRA` times.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    left = EXTRA

    def ring(_number: int, _frame: FrameType | None) -> None:
        nonlocal left
        if left and crowded():
            left -= 1
            signal.setitimer(signal.ITIMER_REAL, seconds, AGAIN)
            return
        raise TooLong

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds, AGAIN)
    try:
        yield
    except TooLong:
        raise NotYet(f"The cell had not ended after {seconds:g} s: look for a loop that never ends.") from None
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


class Printed(io.TextIOBase):
    """What a cell prints: passed on and kept, up to `MOST_OUTPUT` characters."""

    def __init__(self, sink: Any) -> None:
        self._sink = sink
        self._parts: list[str] = []
        self._length = 0

    @property
    def text(self) -> str:
        """What was printed, as far as it is kept."""
        return "".join(self._parts)

    def writable(self) -> bool:
        return True

    def write(self, text: str, /) -> int:
        kept = text[: max(0, MOST_OUTPUT - self._length)]
        self._length += len(text)
        if kept:
            self._parts.append(kept)
            self._sink.write(kept)
        return len(text)

    def flush(self) -> None:
        self._sink.flush()

    def end(self) -> None:
        """Say how much was left out."""
        if self._length > MOST_OUTPUT:
            self._sink.write(f"\n... and {self._length - MOST_OUTPUT:,} more characters\n")
