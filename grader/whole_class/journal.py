"""The journal of a class: one line for each finished submission, on disk before the next step.

It is only ever appended to, and no clock is asked: its order is that of its lines. A killed run loses nothing but its
unfinished gradings: the next run reads the journal, cuts off an incomplete last line, and grades what is missing. The
gradebook is written from the journal alone.
"""

from __future__ import annotations

import contextlib
import errno
import fcntl
import getpass
import json
import os
import socket
from pathlib import Path
from types import TracebackType
from typing import Any

from gz_course.grader.errors import InfrastructureError, UsageError
from gz_course.grader.printable import shown

JOURNAL = "journal.jsonl"
HOLDER = ".in_use_by"  # who grades into the folder
NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP)  # some network file systems have none


class Results:
    """What a journal holds. `done` maps the keys of finished jobs to their results.

    A result names the `folder` that holds its files; if several results name one folder, the files are those of the
    last. `damaged` counts lines that could not be read: their submissions are graded again.
    """

    def __init__(self) -> None:
        self.done: dict[str, dict[str, Any]] = {}
        self.damaged = 0
        self._holds: dict[str, str] = {}  # folder -> key of the result whose files it holds

    def take(self, data: bytes) -> int:
        """Read the whole lines of a journal; return how many bytes they are."""
        whole = data.rfind(b"\n") + 1
        for line in data[:whole].splitlines():
            try:
                entry = json.loads(line)
                self.know(entry["key"], entry["result"])
            except (ValueError, KeyError, TypeError, RecursionError):
                self.damaged += 1
        self.damaged += whole != len(data)
        return whole

    def know(self, key: str, result: dict[str, Any]) -> None:
        self._holds[result["folder"]] = key
        self.done[key] = result

    def current(self, key: str) -> dict[str, Any] | None:
        """Return the result of a job if it is finished and its folder still holds its files."""
        result = self.done.get(key)
        return result if result is not None and self._holds.get(result["folder"]) == key else None

    def held(self, folder: str) -> tuple[str, dict[str, Any]] | None:
        """Return the key and the result whose files a folder holds; None if there are none."""
        key = self._holds.get(folder, "")
        result = self.done.get(key)
        return (key, result) if result is not None and result["folder"] == folder else None

    def all(self) -> list[dict[str, Any]]:
        """Return the results whose folders hold their files."""
        return [result for key, result in self.done.items() if self._holds[result["folder"]] == key]


def read_results(folder: Path) -> Results:
    """Return what the journal of a folder holds, without locking it; empty if there is none."""
    results = Results()
    with contextlib.suppress(OSError):
        results.take((folder / JOURNAL).read_bytes())
    return results


class Journal(Results):
    """An open, locked journal."""

    def __init__(self, folder: Path) -> None:
        """Open or create the journal of a folder. Raises UsageError if another run holds it or it cannot be written."""
        super().__init__()
        self.path = folder / JOURNAL
        try:
            self._file = self.path.open("a+b", buffering=0)
        except OSError as error:
            raise UsageError(f"{self.path} cannot be written: {error.strerror}") from None
        try:
            self._lock(folder)
            self._read()
            _sync_folder(folder)
        except OSError as error:
            self._file.close()
            raise UsageError(f"{self.path} cannot be written: {error.strerror}") from None
        except UsageError:
            self._file.close()
            raise

    def _lock(self, folder: Path) -> None:
        self._holder = folder / HOLDER
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            if error.errno not in NO_LOCKS:
                raise UsageError(
                    f"another course grade-all is at work in {folder}{_told_by(self._holder)}; wait for it, or give "
                    "another --out"
                ) from None
        with contextlib.suppress(OSError):  # a full disk: then nobody is named
            self._holder.write_text(f"{_user()} on {socket.gethostname()}, process {os.getpid()}", encoding="utf-8")

    def _read(self) -> None:
        self._file.seek(0)
        data = self._file.read()
        whole = self.take(data)
        if whole != len(data):
            self._file.truncate(whole)
            os.fsync(self._file.fileno())

    def add(self, key: str, result: dict[str, Any]) -> None:
        """Record that a job is finished; it is on disk when this returns.

        Raises InfrastructureError if the disk takes no more; no part of the line stays.
        """
        line = json.dumps({"key": key, "result": result}, sort_keys=True).encode() + b"\n"
        size = self._file.seek(0, os.SEEK_END)
        try:
            while line:  # a nearly full disk may write only a part
                line = line[self._file.write(line) :]
            os.fsync(self._file.fileno())
        except OSError as error:
            with contextlib.suppress(OSError):
                self._file.truncate(size)
            raise InfrastructureError(
                f"{self.path} cannot be written: {error.strerror}; what is in it stays, and the same command goes on"
            ) from None
        self.know(key, result)

    def close(self) -> None:
        """Release the lock."""
        with contextlib.suppress(OSError):
            self._holder.unlink()
        self._file.close()

    def __enter__(self) -> Journal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _user() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError):  # a user without a name
        return f"user {os.getuid()}"


def _told_by(holder: Path) -> str:
    """Return who holds the lock, in brackets; empty if it is not known."""
    try:
        with holder.open("rb") as stream:
            return f" ({shown(stream.read(200).decode(errors='replace'))})"
    except OSError:
        return ""


def _sync_folder(folder: Path) -> None:
    """Flush the names in a folder to disk, too. Source: fsync(2)."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
