"""What the packages for all services share: trials, the time that one grading may take, programs, and the zip."""

from __future__ import annotations

import io
import stat
import zipfile
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.trial import TRIALS, chosen_trials
from gz_course.grader.process.whole_file import write_whole

START_UP, PER_TRIAL, WALL_FACTOR = 60.0, 30.0, 2.0  # [s], [s] and wall seconds per simulated second of a grading
WHEN = (1980, 1, 1, 0, 0, 0)  # date of every file in the zip, so that the same exercise gives the same bytes


def all_trials(exercise: Exercise) -> str:
    """Return the choice of all trials that there are, hidden ones included."""
    return "all" if (exercise.twin / TRIALS).is_file() else "public"


def filled(program: Path, values: dict[str, str]) -> bytes:
    """Return a program with each `@KEY@` replaced by its value."""
    text = program.read_text(encoding="utf-8")
    for key, value in values.items():
        text = text.replace(f"@{key}@", value)
    return text.encode()


def seconds_for(exercise: Exercise, trials: str) -> float:
    """Return after how long [s] a grading is ended. Raises UsageError if there are no such trials."""
    asked = chosen_trials(exercise, trials)
    return START_UP + sum(PER_TRIAL + WALL_FACTOR * (trial.duration or exercise.duration) for trial in asked)


def write_zip(target: Path, contents: dict[str, bytes]) -> None:
    """Write the zip atomically: `target` holds either its former content or the complete zip. Scripts can be run.

    Raises UsageError if it cannot be written.
    """
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in sorted(contents.items()):
            info = zipfile.ZipInfo(name, WHEN)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = (stat.S_IFREG | (0o755 if data.startswith(b"#!") else 0o644)) << 16
            archive.writestr(info, data)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.is_dir():
            raise UsageError(f"{target} is a folder; give the name of a file, such as {target / 'autograder.zip'}")
        write_whole(target, content.getvalue())
    except OSError as error:
        raise UsageError(f"{target} cannot be written: {error.strerror}") from None
