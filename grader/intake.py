"""Takes a submission in: finds the file asked for and reads it, with what lies beside it, before anything is run.

What cannot be read is a usage error (exit 2). What can be read but can never run is the student's error: it is graded,
with no points, and told the line.
"""

from __future__ import annotations

import hashlib
import stat
from pathlib import Path

from grader.errors import UsageError, nearest
from grader.exercise import Exercise
from grader.kinds.kind import find_kind
from grader.printable import shown
from grader.submission import Submission

LARGEST = 1 << 20  # [bytes] of a submitted file
LARGEST_FOLDER = 16 << 20  # [bytes] of all files of a submitted folder
MOST_FILES = 200  # of a submitted folder


def take_in(exercise: Exercise, path: Path | None) -> Submission:
    """Find and read the submission at `path`: the file itself or a folder with it; None is the student's own copy.

    A folder comes with everything in it, a file alone. Raises UsageError if there is nothing to read.
    """
    path = path if path is not None else exercise.folder
    if not _is_utf8(path):
        raise UsageError(f"{shown(str(path))!r}: a file name must be UTF-8, or ROS cannot start the file; rename it")
    kind = find_kind(exercise.kind)
    folder = path if _is_folder(path) else None
    if folder is not None:
        names = _files(folder, kind.suffixes)
        if exercise.file not in names:
            raise UsageError(
                f"{path} holds no {exercise.file}, the file {exercise.name} asks for{nearest(exercise.file, names)}"
            )
        path = folder / exercise.file
    data = _read(path, exercise.file, kind.suffixes)
    files = {path.name: data}
    if folder is not None:
        files |= _beside(folder)
    return Submission(path.resolve(), path.name, hashlib.sha256(data).hexdigest(), kind.fault(path.name, data), files)


def _read(path: Path, wanted: str, suffixes: tuple[str, ...]) -> bytes:
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise UsageError(f"{path} is not a regular file; give the {wanted} to grade or its folder")
        if status.st_size > LARGEST:
            raise UsageError(f"{path} has {status.st_size} bytes; at most {LARGEST} are accepted")
        with path.open("rb") as stream:
            return stream.read(LARGEST + 1)
    except FileNotFoundError:
        raise UsageError(f"there is no file {path}{nearest(path.name, _files(path.parent, suffixes))}") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"{str(path)[:200]!r} cannot be read: {reason}") from None


def _beside(folder: Path) -> dict[str, bytes]:
    """Return the regular files below a folder: relative name -> content. Symbolic links are left out."""
    files: dict[str, bytes] = {}
    total = 0
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if "__pycache__" in path.parts or path.is_symlink() or not path.is_file() or not _is_utf8(path):
            continue
        total += path.stat().st_size
        if len(files) >= MOST_FILES or total > LARGEST_FOLDER:
            raise UsageError(
                f"{folder} is too large: at most {MOST_FILES} files and {LARGEST_FOLDER} bytes are accepted in a folder"
            )
        files[name] = _read(path, name, ())
    return files


def _is_utf8(path: Path) -> bool:
    try:
        str(path).encode()
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
