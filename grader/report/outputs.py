"""The files a report is written to: that they can be written, and the writing.

Called by `course grade` before the run (`check`) and by it and `course score` after it (`write`).
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
    """Where the reports that are wanted go, by format."""

    files: dict[str, Path] = field(default_factory=dict)

    def check(self, others: Iterable[Path] = (), inputs: Iterable[Path] = ()) -> None:
        """Find out before anything runs whether every file can be written, and `others` such as recordings with them.

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

    def write(self, report: Report) -> None:
        """Write every report that is wanted. Raises UsageError if one cannot be written."""
        for name, path in self.files.items():
            text = formats()[name].as_text(report)
            check_writable(path)
            try:
                path.write_bytes(text.encode(errors="replace"))
            except OSError as error:
                raise UsageError(f"cannot write {_named(path)}: {error.strerror}") from None


def check_writable(path: Path) -> None:
    """Find out whether a file can be written, making its folder. Raises UsageError if not."""
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
    """Tell whether nothing is overwritten there: a terminal, a pipe or /dev/null."""
    return path.exists() and not path.is_file()


def _named(path: Path) -> str:
    return shown(str(path), 4096)
