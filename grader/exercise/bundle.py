"""The files of one exercise that grading needs, held in memory: its public half, what grades it, the hidden trials.

A class is graded from first to last by the exercise as it was when the run began, on this machine or another
(`whole_class/`), and a package for another service holds these files (`package/`). Solutions are never included, so a
submission cannot read them.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.grading import GRADING, README
from gz_course.grader.exercise.trial import TRIALS, load_trials
from gz_course.grader.submission.intake import is_junk

# Files of the private half that solve the exercise or the cells of its chapter, or tell how.
SOLVED = {"accepted", "rejected", "cells", "expect.toml"}
TRACES = (".rrd", ".part", ".pyc", ".orig", ".bak", "~")


def bundle(exercise: Exercise, trials: str = "public") -> tuple[dict[str, bytes], str]:
    """Return the files of an exercise, by their path below a course's root, and the trials to ask for among them.

    `trials` is as for `course grade`; a file is included as the hidden trials. Raises UsageError if there is no such
    file, ManifestError if a file cannot be read.
    """
    public = f"exercises/{exercise.name}"
    files = _files(exercise.folder, public, {GRADING}) | _files(exercise.grading, f"{public}/{GRADING}", set())
    files[f"{public}/{README}"] = _read(exercise.grading.parent / README)
    private = f"solutions/{exercise.name}"
    if trials in ("hidden", "all") and exercise.twin.is_dir():
        files |= _files(exercise.twin, private, SOLVED | set(exercise.parts))
    if trials not in ("public", "hidden", "all"):
        path = Path(trials)
        worlds = {Path(trial.world) for trial in load_trials(path) if trial.world is not None}
        for each in (path, *sorted(world for world in worlds if world.is_file())):
            files[f"{private}/{TRIALS if each == path else each.relative_to(path.parent).as_posix()}"] = _read(each)
        trials = "hidden"
    return files, trials


def digest(files: dict[str, bytes]) -> str:
    """Return the SHA-256 of the names and contents of files, independent of their order."""
    total = hashlib.sha256()
    for name, data in sorted(files.items()):
        for part in (name.encode("utf-8", "surrogateescape"), data):
            total.update(len(part).to_bytes(8, "big") + part)
    return total.hexdigest()


def write(files: dict[str, bytes], folder: Path) -> None:
    for name, data in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


def _files(folder: Path, inside: str, without: set[str]) -> dict[str, bytes]:
    found: dict[str, bytes] = {}
    for path in sorted(folder.rglob("*")):
        parts = path.relative_to(folder).parts
        if (
            parts[0] in without
            or "/".join(parts) in without
            or any(is_junk(part) for part in parts)
            or path.name.endswith(TRACES)
        ):
            continue
        if path.is_file():
            found["/".join((inside, *parts))] = _read(path)
    return found


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise ManifestError(f"{path} cannot be read: {error.strerror}") from None
