"""The starter of an exercise as it was handed out: from the students' copy, else from git.

`course release` leaves all starters in `.starters/`; in a clone, the branch that it follows has them.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise.exercise import Exercise

STARTERS = ".starters"
REVISIONS = ("@{upstream}", "HEAD")  # a student may have committed own work on top of what was handed out


def pristine(exercise: Exercise) -> bytes:
    """Return the starter as it was handed out. Raises UsageError if there is neither a copy of it nor git's."""
    kept = exercise.folder.parents[1] / STARTERS / exercise.name / exercise.file
    if kept.is_file():
        return kept.read_bytes()
    for revision in REVISIONS:
        try:
            shown = subprocess.run(
                ["git", "-C", exercise.folder, "show", f"{revision}:./{exercise.file}"],
                stdin=subprocess.DEVNULL,
                capture_output=True,
                check=False,
            )
        except OSError:
            break
        if shown.returncode == 0:
            return shown.stdout
    raise UsageError(
        f"the starter of {exercise.name} is not known: this copy of the course has neither {STARTERS}/ nor "
        "git's history; get the course again, and take the file from there"
    )


def put_back(exercise: Exercise, keep: Path) -> Path | None:
    """Put the starter back; return where the file that was there is kept now, below the folder `keep`.

    None if nothing was there, or the starter itself. Raises UsageError if a file cannot be written.
    """
    starter = pristine(exercise)
    place, kept = exercise.starter, None
    try:
        before = place.read_bytes() if place.is_file() else starter
        if before != starter:
            number = 1
            while (folder := keep / f"kept-{number}").exists():
                number += 1
            folder.mkdir(parents=True)
            kept = folder / exercise.file
            kept.write_bytes(before)
        place.write_bytes(starter)
    except OSError as error:
        raise UsageError(f"cannot write {error.filename}: {error.strerror}") from None
    return kept
