"""Is there space for recordings and temporary files, and are their folders writable?"""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

from gz_course.grader.tools.doctor.probe import Probes
from gz_course.grader.tools.doctor.verdict import Verdict, failed, fine, warning

TITLE = "disk space and temporary folder"
LEAST, COMFORTABLE = 200 << 20, 1 << 30  # [bytes] free: the recordings of a class take some hundred MB


def examine(probes: Probes) -> Verdict:
    """Examine the temporary folder and the current folder, in which recordings are written."""
    seen = {}
    for folder in (Path(tempfile.gettempdir()), Path.cwd()):
        try:
            with tempfile.TemporaryFile(dir=folder) as stream:
                stream.write(b"x")
                stream.flush()
            seen[folder] = shutil.disk_usage(folder).free
        except OSError as error:
            return failed(
                f"{folder} cannot be written: {error.strerror}", "go to a folder of yours, or set TMPDIR to one"
            )
    return judge(seen)


def judge(free: dict[Path, int]) -> Verdict:
    """Return the verdict on the free space [bytes] of each folder."""
    folder = min(free, key=lambda each: free[each])
    shown = f"{free[folder] / (1 << 30):.1f} GB free in {folder}"
    if free[folder] < LEAST:
        return failed(shown, "make room: old recordings can go, `rm runs/*/*.rrd`")
    if free[folder] < COMFORTABLE:
        return warning(shown, "make room before grading a class: old recordings in runs/ can go")
    return fine(shown)
