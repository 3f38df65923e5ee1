"""Takes a submission in: finds the file asked for and reads it before anything is run.

What cannot be read is a usage error (exit 2). What can be read but is not Python is the student's error: it is
graded, with no points, and told the line.
"""

from __future__ import annotations

import ast
import hashlib
import warnings
from dataclasses import dataclass
from pathlib import Path

from grader.errors import UsageError, nearest
from grader.exercise import Exercise

LARGEST = 1 << 20  # [bytes] of a submitted file


@dataclass(frozen=True)
class Submission:
    """A file to grade. `fault` says in one sentence why it cannot run; None if it can."""

    file: Path
    sha256: str
    fault: str | None = None


def take_in(exercise: Exercise, path: Path | None) -> Submission:
    """Find and read the submission at `path`: the file itself or a folder with it; None is the student's own copy.

    Raises UsageError if there is nothing to read.
    """
    path = path if path is not None else exercise.starter
    if path.is_dir():
        names = _python_files(path)
        if exercise.file not in names:
            raise UsageError(
                f"{path} holds no {exercise.file}, the file {exercise.name} asks for{nearest(exercise.file, names)}"
            )
        path = path / exercise.file
    if not path.exists():
        raise UsageError(f"there is no file {path}{nearest(path.name, _python_files(path.parent))}")
    if not path.is_file():
        raise UsageError(f"{path} is not a regular file; give the {exercise.file} to grade or its folder")
    try:
        data = path.read_bytes()
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror}") from None
    if len(data) > LARGEST:
        raise UsageError(f"{path} has {len(data)} bytes; at most {LARGEST} are accepted")
    return Submission(path.resolve(), hashlib.sha256(data).hexdigest(), _fault(data, path.name))


def _python_files(folder: Path) -> list[str]:
    try:
        return [p.name for p in folder.iterdir() if p.suffix == ".py" and p.is_file()]
    except OSError:
        return []


def _fault(data: bytes, name: str) -> str | None:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an odd escape in a student's string is not our business
            ast.parse(data, name)
    except SyntaxError as error:
        line = f"{name}, line {error.lineno}" if error.lineno else name
        shown = f": {error.text.strip()}" if error.text and error.text.strip() else ""
        return f"{line}: {type(error).__name__}: {error.msg}{shown}"
    except (ValueError, RecursionError, MemoryError) as error:
        return f"{name} cannot be read as Python: {error}"
    return None
