"""The files a report is written to: which formats there are, that their targets can be written, and the writing.

Called by `course grade` before the run (`check`) and by it and `course score` after it (`write`). A format is imported
only when somebody asks for it.
"""

from __future__ import annotations

import errno
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.printable import shown
from gz_course.grader.report.report import Report

FORMATS = ("json", "html", "gradescope", "junit")


@dataclass(frozen=True)
class Outputs:
    """Where the reports go, by format; None: that one is not wanted."""

    json: Path | None = None
    html: Path | None = None
    gradescope: Path | None = None
    junit: Path | None = None

    def check(self, others: Iterable[Path] = (), inputs: Iterable[Path] = ()) -> None:
        """Find out before anything runs whether every file can be written, and `others` such as recordings with them.

        Raises UsageError if one cannot, if two are the same, or if one would overwrite something in `inputs`.
        """
        seen: dict[Path, str] = {path.resolve(): "a recording" for path in others}
        read = [path for path in inputs if path.is_file()]
        for name, path in self._wanted():
            place = path.resolve()
            if place in seen and not _is_stream(path):
                raise UsageError(
                    f"--{name} {_named(path)} would overwrite {seen[place]}; give each report its own file"
                )
            seen[place] = f"the report of --{name}"
            if any(path.exists() and path.samefile(other) for other in read):
                raise UsageError(f"--{name} {_named(path)} would overwrite what is graded; give another file")
        for path in (*others, *(path for _, path in self._wanted())):
            check_writable(path)

    def write(self, report: Report) -> None:
        """Write every report that is wanted. Raises UsageError if one cannot be written."""
        for name, path in self._wanted():
            text = as_text(report, name)
            check_writable(path)
            try:
                path.write_bytes(text.encode(errors="replace"))
            except OSError as error:
                raise UsageError(f"cannot write {_named(path)}: {error.strerror}") from None

    def _wanted(self) -> Iterator[tuple[str, Path]]:
        for name in FORMATS:
            if (path := getattr(self, name)) is not None:
                yield name, path


def as_text(report: Report, name: str) -> str:
    """Return a report in one of FORMATS. Raises UsageError if a recording it needs cannot be read."""
    match name:
        case "html":
            from gz_course.grader.report.html.page import as_html

            return as_html(report)
        case "gradescope":
            from gz_course.grader.report.gradescope import as_gradescope

            return as_gradescope(report)
        case "junit":
            from gz_course.grader.report.junit import as_junit

            return as_junit(report)
    return report.as_json()


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
    """Whether it is no file that could be overwritten, but a terminal, a pipe or /dev/null."""
    return path.exists() and not path.is_file()


def _named(path: Path) -> str:
    return shown(str(path), 4096)
