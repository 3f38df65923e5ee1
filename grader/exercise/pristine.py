"""The starter of an exercise as it was handed out: from the students' copy, else from git.

`course release` leaves all starters in `.starters/`; in a clone, the branch that it follows has them.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise.bundle import write
from gz_course.grader.exercise.exercise import Exercise

STARTERS = ".starters"
REVISIONS = ("@{upstream}", "HEAD")  # a student may have committed own work on top of what was handed out


def pristine(exercise: Exercise) -> dict[str, bytes]:
    """Return the starter as it was handed out, by file. Raises UsageError if there is neither a copy nor git's."""
    return {name: _pristine(exercise, name) for name in exercise.parts}


def _pristine(exercise: Exercise, name: str) -> bytes:
    kept = exercise.folder.parents[1] / STARTERS / exercise.name / name
    if kept.is_file():
        return kept.read_bytes()
    for revision in REVISIONS:
        try:
            shown = subprocess.run(
                ["git", "-C", exercise.folder, "show", f"{revision}:./{name}"],
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
    """Put the starter back; return the folder below `keep` where the files that were there are kept now.

    None if nothing was there, or the starter itself. Raises UsageError if a file cannot be written.
    """
    starter = pristine(exercise)
    kept = None
    try:
        places = {name: exercise.folder / name for name in starter}
        before = {name: place.read_bytes() for name, place in places.items() if place.is_file()}
        if any(content != starter[name] for name, content in before.items()):
            number = 1
            while (folder := keep / f"kept-{number}").exists():
                number += 1
            write(before, folder)
            kept = folder
        write(starter, exercise.folder)
    except OSError as error:
        raise UsageError(f"cannot write {error.filename}: {error.strerror}") from None
    return kept
