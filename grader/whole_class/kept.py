"""Which recordings of a class stay on disk (`--keep`), and what they take.

A recording is most of what a grading leaves. Without it the report, the score and the sentences stay; `course show`,
`course score` and a second look at the run need it.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

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
