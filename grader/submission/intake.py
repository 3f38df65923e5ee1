"""Intake of a submission: finds and reads the expected file and the files beside it before anything is run.

A submission is a file, a folder or an archive (`archive.py`), read into memory once and completely. What cannot be read
is a usage error (exit 2). What can be read but can never run is the student's error: it is graded with no points, and
the report names the line.
"""

from __future__ import annotations

import hashlib
import os
import stat
from datetime import UTC, datetime
from functools import partial
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from gz_course.grader.errors import RefusedError, UnreadableError, UsageError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.grading import GRADING, MANIFEST
from gz_course.grader.kinds.kind import find_kind
from gz_course.grader.printable import shown
from gz_course.grader.submission import Submission
from gz_course.grader.submission.archive import (
    LARGEST_ARCHIVE,
    LONGEST_NAME,
    MOST_MEMBERS,
    Member,
    Tree,
    damaged,
    is_archive,
    open_archive,
)
from gz_course.grader.submission.given_names import as_asked, twice, without_text_suffix
from gz_course.sim.did_you_mean import did_you_mean

LARGEST = 1 << 20  # [bytes] of a submitted file
LARGEST_FOLDER = 16 << 20  # [bytes] of all files of a submitted folder
MOST_FILES = 200  # of a submitted folder
# Files of editors, systems and tools, which nobody means to hand in; neither are hidden files and folders.
JUNK = {"__pycache__", "__MACOSX", "Thumbs.db", "desktop.ini"}
# Python files that replace modules of the same names if their folder comes first on the path: they are left out.
STAND_INS = {"conftest", "sitecustomize", "usercustomize", "numpy", "rclpy"}


class Selection(NamedTuple):
    """The part of a folder or archive that is the submission: everything below `base`; `main` is the expected file.

    `notes` say what was taken under another name, or is there twice (`given_names.py`).
    """

    base: str
    main: str
    files: dict[str, bytes]
    notes: tuple[str, ...] = ()


def take_in(exercise: Exercise, path: Path | None, *, explained: bool = True) -> Submission:
    """Read the submission at `path`: the expected file, or a folder or archive with it; None: the student's copy.

    A folder or an archive comes with everything in it, a file with those of `exercise.files` that lie beside it;
    `explained` is as in `Submission`. Raises UsageError if there is nothing to read or a file of the exercise is
    missing, RefusedError if it must not be read.
    """
    path, main, files, notes = read_submission(exercise, path if path is not None else exercise.folder)
    kind = find_kind(exercise.kind)
    judged = [main, *(name for name in exercise.files if name.endswith(kind.suffixes))]
    fault = next((found for name in judged if (found := kind.fault(name, files[name]))), None)
    total = hashlib.sha256(files[main])
    for name in exercise.files:
        total.update(hashlib.sha256(files[name]).digest())
    return Submission(path.resolve(), main, total.hexdigest(), fault, files, explained, notes)


def read_submission(exercise: Exercise, path: Path) -> tuple[Path, str, dict[str, bytes], tuple[str, ...]]:
    """Return where a submission lies, the name of the expected file, all files, and notes, without judging contents.

    Raises UsageError, or RefusedError, as `take_in` does.
    """
    if not _is_utf8(str(path)):
        raise UsageError(f"{shown(str(path))!r}: a file name must be UTF-8, or ROS cannot start the file; rename it")
    if _is_folder(path):
        chosen = select(folder_tree(path), exercise, str(path))
        return path / chosen.base / chosen.main, chosen.main, chosen.files, chosen.notes
    suffixes = find_kind(exercise.kind).suffixes
    archive = is_archive(path.name) and not path.name.endswith(suffixes)
    data = _read(path, exercise.file, suffixes, LARGEST_ARCHIVE if archive else LARGEST)
    if not archive:
        main = without_text_suffix(path.name, suffixes)
        files = {main: data} | _beside(exercise, path)
        _require(exercise, files, str(path))
        return path, main, files, () if main == path.name else (f"{shown(path.name)} is taken as {shown(main)}.",)
    chosen = select(open_archive(path.name, data), exercise, str(path))
    return path, chosen.main, chosen.files, chosen.notes


def _beside(exercise: Exercise, path: Path) -> dict[str, bytes]:
    """Return those of the exercise's further files that lie beside a submitted file; a link is none of them."""
    found = {}
    for name in exercise.files:
        member = folder_member(path.parent / name)
        if member is not None and member.refusal is None:
            found[name] = _content(member, name, str(path.parent), LARGEST)
    return found


def _require(exercise: Exercise, files: dict[str, bytes], where: str) -> None:
    """Raise UsageError naming the first of the exercise's further files that was not handed in."""
    for name in exercise.files:
        if name not in files:
            near = did_you_mean(name, [shown(each) for each in files], listing="files there are")
            raise UsageError(
                f"{where} comes without {name}: {exercise.name} asks for {', '.join(exercise.parts)}; hand them in "
                f"together, in a folder or an archive{near}"
            )


def folder_tree(folder: Path) -> Tree:
    """Return the regular files below a folder. Symbolic links and junk are left out; no link is followed.

    Raises RefusedError if there are too many or nested too deep, UnreadableError if the machine cannot read them.
    """
    tree: Tree = {}
    seen = 0

    def unreadable(error: OSError) -> None:
        if isinstance(error, FileNotFoundError) and folder.exists():
            return  # a subfolder that was removed meanwhile
        raise UnreadableError(f"{shown(str(error.filename), 200)} cannot be read: {error.strerror}")

    for parent, folders, names in os.walk(folder, onerror=unreadable):
        folders[:] = sorted(name for name in folders if not is_junk(name))
        seen += len(folders) + len(names)
        if seen > MOST_MEMBERS:
            raise RefusedError(f"{folder} is too large: it holds more than {MOST_MEMBERS} files")
        below = parent[len(str(folder)) + 1 :]
        if len(os.fsencode(below)) > LONGEST_NAME:  # before paths or Python's recursion reach their limits
            raise RefusedError(f"{folder} holds folders in folders too deep: {shown(below, 60)!r}")
        for name in sorted(names):
            path = Path(parent, name)
            inside = f"{below}/{name}" if below else name
            if is_junk(name) or not _is_utf8(inside):
                continue
            member = folder_member(path)
            if member is not None and member.refusal is None:
                tree[inside] = member
    return tree


def folder_member(path: Path) -> Member | None:
    """Return a file as a member of its folder; None if it is gone. A file that is not regular is marked as refused."""
    try:
        status = path.lstat()
    except OSError:
        return None
    refusal = None
    if not stat.S_ISREG(status.st_mode):
        refusal = "is a link" if stat.S_ISLNK(status.st_mode) else "is a device or a pipe"
    try:
        modified = datetime.fromtimestamp(status.st_mtime, UTC)
    except (ValueError, OverflowError, OSError):  # a year that Python does not know
        modified = None
    return Member(status.st_size, partial(_read, path, path.name, ()), refusal, modified)


def is_junk(name: str) -> bool:
    """Return whether a file or folder of this name was left behind by a tool and not handed in."""
    return name.startswith(".") or name in JUNK


def without_grading(tree: Tree) -> Tree:
    """Return a tree without what grades an exercise, as in a clone of the course: no submission sees it."""
    graders = [name.removesuffix(MANIFEST) for name in tree if f"/{name}".endswith(f"/{GRADING}/{MANIFEST}")]
    return {name: member for name, member in tree.items() if not name.startswith(tuple(graders))}


def select(tree: Tree, exercise: Exercise, where: str, *, nested: bool = False, own_name: bool = False) -> Selection:
    """Find the expected file in a folder or archive and read it, with everything beside and below it.

    It may be anywhere if it is there only once. If it is missing, the only file of its type is taken whatever its name,
    and a single archive is opened. `own_name`: the file has its student's name, which needs no note.
    Raises UsageError if there is none, RefusedError if something must not be read.
    """
    tree = {n: m for n, m in tree.items() if not any(map(is_junk, n.split("/"))) and _is_utf8(n)}
    tree, notes = as_asked(without_grading(tree), exercise, where)
    for name, member in sorted(tree.items()):
        if member.refusal:
            raise RefusedError(f"{where} holds {shown(name)!r}, which {member.refusal}; send plain files")
    archives = [name for name in tree if is_archive(name)]
    if len(archives) == 1 and not nested and not _named(tree, exercise.file):
        data = _content(tree[archives[0]], archives[0], where, LARGEST_ARCHIVE)
        archive = open_archive(PurePosixPath(archives[0]).name, data)
        return select(archive, exercise, f"{where}: {shown(archives[0])}", nested=True)
    main = _main(tree, exercise, where)
    base = str(PurePosixPath(main).parent)
    if PurePosixPath(main).name != exercise.file and not own_name:
        notes.append(f"There is no {exercise.file}; {shown(main)}, the only file of its kind, is taken for it.")
    notes += twice(tree, base, exercise)
    inside = {name if base == "." else name[len(base) + 1 :]: name for name in tree if base in (".", *_above(name))}
    chosen = {short: name for short, name in inside.items() if name == main or not _stands_in(short)}
    if len(chosen) > MOST_FILES or sum(tree[name].size for name in chosen.values()) > LARGEST_FOLDER:
        raise RefusedError(
            f"{where} is too large: at most {MOST_FILES} files and {LARGEST_FOLDER} bytes are accepted in a folder"
        )
    if both := [name for short, name in chosen.items() if any(parent in chosen for parent in _above(short))]:
        raise RefusedError(f"{where} holds {shown(min(both))!r} below a file, where no file can be")
    files = {short: _content(tree[name], name, where, LARGEST) for short, name in sorted(chosen.items())}
    if sum(map(len, files.values())) > LARGEST_FOLDER:
        raise RefusedError(f"{where} is too large: at most {LARGEST_FOLDER} bytes are accepted in a folder")
    _require(exercise, files, where)
    return Selection(base, PurePosixPath(main).name, files, tuple(notes))


def _named(tree: Tree, wanted: str) -> list[str]:
    return sorted(name for name in tree if name.rpartition("/")[2] == wanted)


def _main(tree: Tree, exercise: Exercise, where: str) -> str:
    """Return the name of the expected file in `tree`. Raises UsageError if there is none, or several."""
    wanted = exercise.file
    if wanted in tree:
        return wanted
    found = _named(tree, wanted)
    # the student's copy of the course
    of_course = [name for name in found if name.endswith(f"exercises/{exercise.name}/{wanted}")]
    for candidates in (of_course, found):
        if len(candidates) == 1:
            return candidates[0]
    if found:
        raise UsageError(f"{where} holds {wanted} {len(found)} times: {shown(', '.join(found))}; keep one")
    suffixes = find_kind(exercise.kind).suffixes
    others = tuple(f"/{part}" for part in exercise.files)
    names = [name for name in tree if name.endswith(suffixes) and not f"/{name}".endswith(others)]
    if len(names) == 1:
        return names[0]
    names = [name for name in tree if name.endswith(suffixes)]
    near = did_you_mean(wanted, [shown(PurePosixPath(name).name) for name in names], listing="files in it are")
    raise UsageError(f"{where} holds no {wanted}, the file {exercise.name} asks for{near}")


def _above(name: str) -> list[str]:
    parts = name.split("/")
    return ["/".join(parts[:count]) for count in range(len(parts) - 1, 0, -1)]


def _stands_in(name: str) -> bool:
    return any(part.partition(".")[0] in STAND_INS for part in name.split("/"))


def _content(member: Member, name: str, where: str, largest: int) -> bytes:
    """Read a file completely. Raises RefusedError if it is larger than `largest` bytes, or than it claims."""
    if member.size > largest:
        raise RefusedError(f"{where}: {shown(name)} has {member.size} bytes; at most {largest} are accepted")
    try:
        data = member.read(largest + 1)
    except UsageError:
        raise
    except Exception as error:  # the exceptions that readers raise for deliberately damaged archives are not documented
        raise damaged(f"{where}: {shown(name)}", error) from None
    if len(data) > largest:
        raise RefusedError(f"{where}: {shown(name)} has more than {largest} bytes")
    return data


def _read(path: Path, wanted: str, suffixes: tuple[str, ...], largest: int) -> bytes:
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise UsageError(f"{path} is not a regular file; give the {wanted} to grade or its folder")
        if status.st_size > largest:
            raise RefusedError(f"{path} has {status.st_size} bytes; at most {largest} are accepted")
        with path.open("rb") as stream:
            return stream.read(largest + 1)
    except FileNotFoundError:
        hint = did_you_mean(path.name, _files(path.parent, suffixes), listing="files there are")
        raise UsageError(f"there is no file {path}{hint}") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UnreadableError(f"{str(path)[:200]!r} cannot be read: {reason}") from None


def _is_utf8(name: str) -> bool:
    try:
        name.encode()
    except UnicodeEncodeError:
        return False
    return True


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except (OSError, ValueError):
        return False


def _files(folder: Path, suffixes: tuple[str, ...]) -> list[str]:
    try:
        return [p.name for p in folder.iterdir() if p.name.endswith(suffixes) and p.is_file()]
    except OSError:
        return []
