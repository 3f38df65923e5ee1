"""Takes a submission in: finds the file asked for and reads it before anything is run.

What cannot be read is a usage error (exit 2). What can be read but is not Python is the student's error: it is
graded, with no points, and told the line.
"""

from __future__ import annotations

import hashlib
import io
import stat
import tokenize
import warnings
from dataclasses import dataclass
from pathlib import Path

from grader.errors import UsageError, nearest
from grader.exercise import Exercise
from grader.printable import shown

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
    if not _is_utf8(path):
        raise UsageError(f"{shown(str(path))!r}: a file name must be UTF-8, or ROS cannot start the file; rename it")
    if _is_folder(path):
        names = _python_files(path)
        if exercise.file not in names:
            raise UsageError(
                f"{path} holds no {exercise.file}, the file {exercise.name} asks for{nearest(exercise.file, names)}"
            )
        path = path / exercise.file
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise UsageError(f"{path} is not a regular file; give the {exercise.file} to grade or its folder")
        if status.st_size > LARGEST:
            raise UsageError(f"{path} has {status.st_size} bytes; at most {LARGEST} are accepted")
        with path.open("rb") as stream:
            data = stream.read(LARGEST + 1)
    except FileNotFoundError:
        raise UsageError(f"there is no file {path}{nearest(path.name, _python_files(path.parent))}") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"{str(path)[:200]!r} cannot be read: {reason}") from None
    return Submission(path.resolve(), hashlib.sha256(data).hexdigest(), _fault(data, path.name))


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


def _python_files(folder: Path) -> list[str]:
    try:
        return [p.name for p in folder.iterdir() if p.suffix == ".py" and p.is_file()]
    except OSError:
        return []


def _fault(data: bytes, name: str) -> str | None:
    try:
        # compile() passes bytes in a comment that are not UTF-8; Python, which is given the file, does not.
        data.decode(tokenize.detect_encoding(io.BytesIO(data).readline)[0])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an odd escape in a student's string is not our business
            compile(data, name, "exec", dont_inherit=True)
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        return shown(f"{name}, line {line}: this is not {error.encoding}: byte 0x{data[error.start]:02x}")
    except SyntaxError as error:
        line_number = f"{name}, line {error.lineno}" if error.lineno else name
        code = f": {error.text.strip()}" if error.text and error.text.strip() else ""
        return shown(f"{line_number}: {type(error).__name__}: {error.msg}{code}")
    except (ValueError, RecursionError, MemoryError, LookupError) as error:
        return shown(f"{name} cannot be read as Python: {type(error).__name__}: {error}")
    return None
