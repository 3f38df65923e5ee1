"""One Python is tried: a clone, an environment, and the commands that must succeed in it."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import time
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from .interpreters import Interpreter

SUITE = ((3, 11), (3, 12))  # versions with which the whole suite runs
DEADLINE = 3600.0  # [s] for one command
PATIENCE = 10.0  # [s] for a group of processes to end, before the next signal
_VARIABLES_OF_ANOTHER = ("VIRTUAL_ENV", "PYTHONHOME", "PYTHONPATH", "MAKEFLAGS", "MFLAGS", "MAKELEVEL")
_SUMMARY = re.compile(r"^=*\s*(\d+ (?:passed|failed)[^=\n]*)", re.MULTILINE)


@dataclass(frozen=True)
class Outcome:
    """What one command did: whether it succeeded, its time [s], what it says of itself, and the file of its output."""

    command: str
    succeeded: bool
    seconds: float
    said: str
    log: Path


def commands(interpreter: Interpreter, exercises: Iterable[str], *, suite: bool = True) -> list[list[str]]:
    """Return what is run with a Python: the suite, or the demo and every exercise's solution."""
    make = ["make", f"PYTHON={interpreter.path}"]
    if suite and interpreter.version[:2] in SUITE:
        return [[*make, "test"]]
    grade = [".venv/bin/course", "grade"]
    return [[*make, "demo"], *([*grade, name, "--submission", f"solutions/{name}", "--no-page"] for name in exercises)]


def tried(interpreter: Interpreter, checkout: Path, folder: Path, *, suite: bool = True) -> Iterable[Outcome]:
    """Clone the checkout into a folder, and yield the outcome of each command; output goes to files in the folder."""
    clone = folder / "clone"
    subprocess.run(["git", "clone", "--quiet", str(checkout), str(clone)], check=True)
    exercises = sorted(each.name for each in (clone / "exercises").iterdir() if each.is_dir())
    for number, command in enumerate(commands(interpreter, exercises, suite=suite)):
        log = folder / f"{number:02}.log"
        begin = time.monotonic()
        code = _run(command, clone, log)
        text = log.read_text(errors="replace")
        summary = _SUMMARY.findall(text)
        said = summary[-1].strip() if summary else f"exit {code}"
        shown = " ".join(word for word in command if not word.startswith(("PYTHON=", "--no-page")))
        yield Outcome(shown, code == 0, time.monotonic() - begin, said, log)


def _run(command: list[str], folder: Path, log: Path) -> int:
    """Run a command in a process group of its own; return its exit code, or that of the signal that ended it."""
    environment = {name: value for name, value in os.environ.items() if name not in _VARIABLES_OF_ANOTHER}
    with log.open("wb") as output:
        child = subprocess.Popen(
            command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=output, stderr=output,
            start_new_session=True,
        )  # fmt: skip
        try:
            return child.wait(DEADLINE)
        except subprocess.TimeoutExpired:
            return 124
        finally:
            _end(child)


def _end(child: subprocess.Popen[bytes]) -> None:
    """End a command in the usual order of signals, and then whatever is left of its group."""
    for number in (signal.SIGINT, signal.SIGTERM):
        if child.poll() is None:
            os.killpg(child.pid, number)
            with suppress(subprocess.TimeoutExpired):
                child.wait(PATIENCE)
    with suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGKILL)
    child.wait()
