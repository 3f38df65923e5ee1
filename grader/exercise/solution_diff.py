"""The unified diff between the starter of an exercise and its solution; used by `course diff`."""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise

PRIVATE_ONLY = ("expect.toml", "trials.toml")  # describe the variants, not part of a solution


def solution_diff(exercise: Exercise) -> Iterator[str]:
    """Yield the lines of a unified diff for each file of the solution that differs from the public half.

    Raises UsageError if this copy of the course does not have the solution.
    """
    folder = exercise.twin
    if not (folder / exercise.file).is_file():
        raise UsageError(
            f"there is no solution of {exercise.name} to compare with: this copy of the course comes without "
            "solutions, or its author has not written one yet"
        )
    for path in sorted(each for each in folder.iterdir() if each.is_file() and not each.name.startswith(".")):
        if path.name not in PRIVATE_ONLY:
            public = exercise.folder / path.name
            before, after = _lines(public), _lines(path)
            names = f"exercises/{exercise.name}/{path.name}", f"solutions/{exercise.name}/{path.name}"
            source = names[0] if public.is_file() else "/dev/null"
            yield from difflib.unified_diff(before, after, source, names[1], lineterm="")


def _lines(path: Path) -> list[str]:
    """Return the lines of a text file, a note for a binary file, nothing for a missing file."""
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        return []
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror}") from None
    try:
        return data.decode("utf-8-sig").split("\n")[: -1 if data.endswith(b"\n") else None]
    except UnicodeDecodeError:
        return [f"({len(data)} bytes that are no text)"]
