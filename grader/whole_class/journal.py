"""The journal of a class: one line for each finished submission, on disk before the next step.

It is only ever appended to. A killed run loses nothing but its unfinished gradings: the next run reads the journal,
cuts off an incomplete last line, and grades what is missing. The gradebook is written from the journal alone.
"""

from __future__ import annotations

import fcntl
import json
import os
from pathlib import Path
from types import TracebackType
from typing import Any

from gz_course.grader.errors import UsageError

JOURNAL = "journal.jsonl"


class Journal:
    """An open, locked journal. `done` maps the keys of finished jobs to their results.

    A result names the `folder` that holds its files; if several results name one folder, the files are those of the
    last.
    """

    def __init__(self, folder: Path) -> None:
        """Open or create the journal of a folder. Raises UsageError if another run holds it or it cannot be written."""
        self.path = folder / JOURNAL
        try:
            self._file = self.path.open("a+b", buffering=0)
        except OSError as error:
            raise UsageError(f"{self.path} cannot be written: {error.strerror}") from None
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            self._file.close()
            raise UsageError(
                f"another course grade-all is at work in {folder}; wait for it, or give another --out"
            ) from None
        self.done: dict[str, dict[str, Any]] = {}
        self._holds: dict[str, str] = {}  # folder -> key of the result whose files it holds
        self._read()
        _sync_folder(folder)

    def _read(self) -> None:
        self._file.seek(0)
        data = self._file.read()
        whole = data.rfind(b"\n") + 1
        for line in data[:whole].splitlines():
            try:
                entry = json.loads(line)
                self._know(entry["key"], entry["result"])
            except (ValueError, KeyError, TypeError):
                continue  # damaged by the disk: that submission is graded again
        if whole != len(data):
            self._file.truncate(whole)
            os.fsync(self._file.fileno())

    def add(self, key: str, result: dict[str, Any]) -> None:
        """Record that a job is finished; it is on disk when this returns."""
        line = json.dumps({"key": key, "result": result}, sort_keys=True).encode() + b"\n"
        while line:  # a nearly full disk may write only a part
            line = line[self._file.write(line) :]
        os.fsync(self._file.fileno())
        self._know(key, result)

    def current(self, key: str) -> dict[str, Any] | None:
        """Return the result of a job if it is finished and its folder still holds its files."""
        result = self.done.get(key)
        return result if result is not None and self._holds.get(result["folder"]) == key else None

    def _know(self, key: str, result: dict[str, Any]) -> None:
        self._holds[result["folder"]] = key
        self.done[key] = result

    def close(self) -> None:
        """Release the lock."""
        self._file.close()

    def __enter__(self) -> Journal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _sync_folder(folder: Path) -> None:
    """Flush the names in a folder to disk, too. Source: fsync(2)."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
