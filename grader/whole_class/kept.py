"""Which recordings of a class stay on disk (`--keep`), and what they take.

A recording is most of what a grading leaves. Without it the report, the score and the sentences stay; `course show`,
`course score` and a second look at the run need it.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from gz_course.grader.process.whole_file import write_whole
from gz_course.grader.whole_class.grading import REPORT

KEEP = ("all", "failing", "none")
RECORDING = ".rrd"


def is_kept(keep: str, score: float, most: float) -> bool:
    """Return whether the recordings of a submission with this score are kept."""
    return keep == "all" or (keep == "failing" and score < most)


def without_recordings(files: dict[str, bytes]) -> dict[str, bytes]:
    """Return the files of a grading without its recordings; the report names none."""
    report = json.loads(files[REPORT])
    for place in (report, *report.get("trials", ())):
        place["recording"] = None
    left = {name: data for name, data in files.items() if not name.endswith(RECORDING)}
    return left | {REPORT: (json.dumps(report, indent=2) + "\n").encode()}


def free_recordings(folder: Path) -> bool:
    """Remove the recordings of a student's folder, and their names from the report; return whether there were any.

    Raises OSError if that cannot be done.
    """
    recordings = sorted(folder.glob(f"*{RECORDING}"))
    if not recordings:
        return False
    report = without_recordings({REPORT: (folder / REPORT).read_bytes()})[REPORT]
    write_whole(folder / REPORT, report)
    for each in recordings:
        each.unlink()
    return True


def with_notes(files: dict[str, bytes], notes: Sequence[str]) -> dict[str, bytes]:
    """Return the files of a grading whose report has these notes, too."""
    if not notes:
        return files
    report = json.loads(files[REPORT])
    report["notes"] = list(dict.fromkeys([*notes, *report.get("notes", ())]))
    return files | {REPORT: (json.dumps(report, indent=2) + "\n").encode()}


def recordings_on_disk(out: Path, results: Iterable[dict[str, Any]]) -> tuple[int, int]:
    """Return how many students have recordings in the folder of a class, and what these take [bytes]."""
    students = size = 0
    for result in results:
        try:
            with os.scandir(out / result["folder"]) as entries:
                sizes = [entry.stat().st_size for entry in entries if entry.name.endswith(RECORDING)]
        except OSError:
            continue
        students, size = students + bool(sizes), size + sum(sizes)
    return students, size


def readable_size(size: float) -> str:
    """Return a number of bytes with a unit: `190 kB`, `1.9 GB`."""
    for unit in ("bytes", "kB", "MB", "GB"):
        if size < 999.5:
            return f"{size:.0f} {unit}" if unit in ("bytes", "kB") or size >= 9.95 else f"{size:.1f} {unit}"
        size /= 1000
    return f"{size:.1f} TB"
