"""The files to which reports are written: the check that they can be written, and the writing.

`course grade` calls `check` before the run; it and `course score` call `write` after it.
"""

from __future__ import annotations

import errno
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.printable import shown
from gz_course.grader.report.format import formats
from gz_course.grader.report.report import Report


@dataclass(frozen=True)
class Outputs:
    """The files of the reports that were asked for, by format."""

    files: dict[str, Path] = field(default_factory=dict)

    def check(self, others: Iterable[Path] = (), inputs: Iterable[Path] = ()) -> None:
        """Check before the run that every file, and `others` such as recordings, can be written.

        Raises UsageError if one cannot, if two are the same, or if one would overwrite something in `inputs`.
        """
        seen: dict[Path, str] = {path.resolve(): "a recording" for path in others}
        read = [path for path in inputs if path.is_file()]
        for name, path in self.files.items():
            place = path.resolve()
            if place in seen and not _is_stream(path):
                raise UsageError(
                    f"--{name} {_named(path)} would overwrite {seen[place]}; give each report its own file"
                )
            seen[place] = f"the report of --{name}"
            if any(path.exists() and path.samefile(other) for other in read):
                raise UsageError(f"--{name} {_named(path)} would overwrite what is graded; give another file")
        for path in (*others, *self.files.values()):
            check_writable(path)

    def prepare(self) -> None:
        """Do what can be done before there is a report."""
        for name in self.files:
            formats()[name].prepare()

    def write(self, report: Report) -> None:
        """Write every report that was asked for. Raises UsageError if one cannot be written."""
        for name, path in self.files.items():
            made = formats()[name].as_text(report)
            check_writable(path)
            try:
                path.write_bytes(made if isinstance(made, bytes) else made.encode(errors="replace"))
            except OSError as error:
                raise UsageError(f"cannot write {_named(path)}: {error.strerror}") from None


def check_writable(path: Path) -> None:
    """Check that a file can be written, and make its folder. Raises UsageError if not."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, "it is a folder")
        existed = path.exists()
        with path.open("ab"):
            pass
        if not existed:
            path.unlink()
    except (OSError, ValueError) as error:
        raise UsageError(f"cannot write {_named(path)}: {getattr(error, 'strerror', None) or error}") from None


def _is_stream(path: Path) -> bool:
    """Return whether writing there overwrites nothing: a terminal, a pipe or /dev/null."""
    return path.exists() and not path.is_file()


def _named(path: Path) -> str:
    return shown(str(path), 4096)
