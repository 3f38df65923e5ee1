"""A fault in the Python of an author's check: its line, its traceback, and the recording at which it happened.

The kind `python` raises it, `grade.py` leaves recording and traceback behind, `course verify` moves them out of its
temporary folder.
"""

from __future__ import annotations

import contextlib
import shutil
import traceback
from pathlib import Path
from types import TracebackType

from gz_course.grader.errors import ManifestError

TRACEBACK = ".traceback.txt"


class CheckFault(ManifestError):
    """A check of an author raised an error. `trace` is its traceback, without what the grader called before."""

    def __init__(self, sentence: str, trace: str = "", recording: Path | None = None) -> None:
        super().__init__(sentence)
        self.sentence, self.trace, self.recording = sentence, trace, recording

    def __str__(self) -> str:
        if self.recording is None:
            return self.sentence
        return (
            f"{self.sentence}; the recording is kept, {self.recording}, and the traceback beside it, "
            f"{trace_of(self.recording).name}: repair the check and type `course score {self.recording}`"
        )


def trace_of(recording: Path) -> Path:
    """Return the file beside a recording that holds the traceback."""
    return recording.with_name(f"{recording.name.removesuffix('.rrd')}{TRACEBACK}")


def from_authors_line(error: Exception, folder: Path) -> str:
    """Return the traceback of an error from the first line of a file in `folder` on."""
    place: TracebackType | None = error.__traceback__
    while place is not None and Path(place.tb_frame.f_code.co_filename).parent != folder:
        place = place.tb_next
    return "".join(traceback.format_exception(type(error), error, place or error.__traceback__))


def left_behind(fault: CheckFault, recording: Path) -> CheckFault:
    """Write the traceback beside a recording that stays; return the fault that names both."""
    with contextlib.suppress(OSError):
        trace_of(recording).write_text(fault.trace, encoding="utf-8")
    return CheckFault(fault.sentence, fault.trace, recording)


def moved(fault: CheckFault, folder: Path) -> CheckFault:
    """Move recording and traceback of a fault to a folder that stays; return the fault that names the new place."""
    if fault.recording is None or not fault.recording.is_file():
        return fault
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / fault.recording.name
    shutil.move(fault.recording, target)
    return left_behind(fault, target)
