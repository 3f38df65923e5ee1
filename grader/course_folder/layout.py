"""Lays the course out in a folder, and brings a newer version of it there without touching what the student changed.

`.course.json` keeps the version and the SHA-256 of every file as it was laid out. A file that still has it is replaced.
A file that was changed stays, and the newer one is written beside it (`bridge.new.yaml`). A notebook that was only run
counts as unchanged. The starters are in `.starters/`, where `course reset` finds them.
"""

from __future__ import annotations

import hashlib
import json
import shutil
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path

from gz_course.grader.course_folder.material import material, material_files, plain_files
from gz_course.grader.course_folder.readme import FROM_A_WHEEL, readme
from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import exercise_names, find_exercise
from gz_course.grader.exercise.bundle import write
from gz_course.grader.exercise.exercise import is_below
from gz_course.grader.exercise.pristine import STARTERS
from gz_course.grader.process.whole_file import write_whole
from gz_course.grader.tools.notebook_outputs import as_committed

RECORD = ".course.json"
RELEASED = ".released.json"  # the record of a copy that `course release` wrote, programs included
DISTRIBUTION = "gz-ros2-course"
SOLUTIONS = "solutions"


@dataclass
class Changes:
    """The result of an update: paths in the folder. `kept` are those that the student changed -> the newer file."""

    added: list[str] = field(default_factory=list)
    replaced: list[str] = field(default_factory=list)
    removed: list[str] = field(default_factory=list)
    kept: dict[str, str] = field(default_factory=dict)

    @property
    def lines(self) -> list[str]:
        """What to tell the student: a line for each file, hidden ones aside."""
        groups = (("new", self.added), ("replaced", self.replaced), ("removed", self.removed))
        said = [f"{what}: {name}" for what, names in groups for name in names if not name.startswith(".")]
        return said + [f"kept: {name} is yours; the newer one is {newer}" for name, newer in self.kept.items()]


def handed_out(*, solutions: bool = False) -> dict[str, bytes]:
    """Return the files of a student's folder, by path. Raises UsageError if solutions are asked for and not there."""
    root = material()
    files = {inside.as_posix(): path.read_bytes() for inside, path in material_files(root)}
    exercises = [find_exercise(name, root) for name in exercise_names(root)]
    for exercise in exercises:
        for name in exercise.parts:
            files[f"{STARTERS}/{exercise.name}/{name}"] = files[f"exercises/{exercise.name}/{name}"]
    notebooks = sorted(name for name in files if name.endswith(".ipynb"))
    files["README.md"] = readme(exercises, FROM_A_WHEEL, notebooks).encode()
    if solutions:
        private = root / SOLUTIONS
        if not private.is_dir():
            raise UsageError("an installed course has no solutions; run `course init --with-solutions` from a checkout")
        files |= {f"{SOLUTIONS}/{p.relative_to(private).as_posix()}": p.read_bytes() for p in plain_files(private)}
    return files


def lay_out(folder: Path, *, solutions: bool = False) -> list[str]:
    """Write the course to a folder; return the names of its exercises.

    Raises UsageError unless the folder is new or empty, or if it cannot be written.
    """
    try:
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            what = "not empty" if folder.is_dir() else "a file"
            better = "; `course update` brings newer chapters there" if (folder / RECORD).is_file() else ""
            raise UsageError(f"{folder} is {what}; give a folder that is new or empty{better}")
        write_new(folder, handed_out(solutions=solutions))
    except OSError as error:
        raise UsageError(f"{folder} cannot be written: {error.strerror}") from None
    return exercise_names(folder)


def write_new(folder: Path, files: dict[str, bytes]) -> None:
    """Write the files of a folder that is new or empty, and their record. What is incomplete is removed."""
    existed = folder.exists()
    try:
        write(files, folder)
        record(folder, files)
    except BaseException:
        for each in folder.iterdir() if existed else [folder]:
            shutil.rmtree(each, ignore_errors=True) if each.is_dir() else each.unlink()
        raise


def update(folder: Path) -> Changes:
    """Bring the installed course to a folder that an older one was laid out in.

    Raises UsageError if the folder was not made by `course init`, by a newer version, or cannot be written.
    """
    return bring(folder, handed_out(solutions=(folder / SOLUTIONS).is_dir() and (material() / SOLUTIONS).is_dir()))


def update_from(folder: Path, source: Path) -> Changes:
    """Bring the files of a newer copy to a folder, by the records of both; raise as `update`."""
    try:
        files = {name: (source / name).read_bytes() for name in _read_record(source, RELEASED)}
    except OSError as error:
        raise UsageError(f"{error.filename} cannot be read: {error.strerror}") from None
    return bring(folder, files, RELEASED)


def bring(folder: Path, files: dict[str, bytes], kept_in: str = RECORD) -> Changes:
    """Bring files to a folder and leave alone what the student has changed, by its record, the file `kept_in`.

    Raises what `update` raises.
    """
    before = _read_record(folder, kept_in)
    changes = Changes()
    try:
        for name, content in files.items():
            path, was = folder / name, before.get(name)
            there = path.read_bytes() if path.is_file() else None
            if there is None:
                if was is None or was != _digest(name, content):  # a file that the student removed stays away
                    _replace(path, content)
                    changes.added.append(name)
            elif _digest(name, there) == _digest(name, content):
                continue
            elif _digest(name, there) == was:
                _replace(path, content)
                changes.replaced.append(name)
            elif was != _digest(name, content):
                beside = path.with_name(f"{path.stem}.new{path.suffix}")
                _replace(beside, content)
                changes.kept[name] = beside.relative_to(folder).as_posix()
        for name, was in before.items():
            path = folder / name
            if name not in files and path.is_file() and _digest(name, path.read_bytes()) == was:
                path.unlink()
                changes.removed.append(name)
        record(folder, files, kept_in)
    except OSError as error:
        raise UsageError(f"{error.filename} cannot be written: {error.strerror}") from None
    return changes


def _read_record(folder: Path, kept_in: str) -> dict[str, str]:
    path = folder / kept_in
    if not path.is_file():
        advice = (
            "in a clone, `make update` gets the newest version"
            if (folder / ".git").exists()
            else "name the folder that was"
        )
        made_by = "course init" if kept_in == RECORD else "course release"
        raise UsageError(f"{folder} was not made by `{made_by}`; {advice}")
    try:
        about = json.loads(path.read_bytes())
        files, made_by = about["files"], str(about["version"])
        if not all(isinstance(name, str) and isinstance(digest, str) for name, digest in files.items()):
            raise ValueError
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        raise UsageError(f"{path} cannot be read; run `course init` on a new folder and copy your work there") from None
    if _order(made_by) > _order(version(DISTRIBUTION)):
        raise UsageError(
            f"{folder} was made by version {made_by}, and {version(DISTRIBUTION)} is installed: "
            f"`pip install --upgrade {DISTRIBUTION}` first"
        )
    return {name: digest for name, digest in files.items() if is_below(name)}


def _order(number: str) -> list[int]:
    return [int(part) for part in number.split(".") if part.isdigit()]


def _digest(name: str, content: bytes) -> str:
    """Return the SHA-256 of a file; that of a notebook is without what a run leaves in it."""
    if name.endswith(".ipynb"):
        content = as_committed(content.decode("utf-8", "replace")).encode()
    return hashlib.sha256(content).hexdigest()


def _replace(path: Path, content: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, content)


def record(folder: Path, files: dict[str, bytes], kept_in: str = RECORD) -> None:
    """Write the record of files that were laid out in a folder."""
    digests = {name: _digest(name, content) for name, content in sorted(files.items())}
    about = {"version": version(DISTRIBUTION), "files": digests}
    _replace(folder / kept_in, (json.dumps(about, indent=1) + "\n").encode())
