"""`python`: a function in the exercise's own folder, for checks that no other kind can express.

kind = "python"
function = "checks.py:drives_in_circles"     # a file beside the manifest, and the function in it
turns = 2                 # every other parameter is passed to the function unchanged

    def drives_in_circles(recording, parameters):
        yaw = recording.signal("truth/robot/yaw").values
        turned = abs(yaw[-1]) / 6.28 if len(yaw) else 0.0
        wanted = parameters["turns"]
        return Finding(turned >= wanted, expected=f"{wanted} turns", measured=f"{turned:.1f} turns")

`recording` is a grader.record.reading.Recording, `Finding` is that of grader.score.check. The parameters of the trial
are `json.loads(recording.properties("run")["trial_parameters"])["parameters"]`. The file is the author's: it is public
and runs in the grader's own process. It must use nothing but its arguments, so that a score can be computed again.
"""

from __future__ import annotations

import runpy
import traceback
from pathlib import Path
from typing import Any

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.sim.did_you_mean import did_you_mean


@check_kind("python")
def python(recording: Recording, parameters: Table) -> Finding:
    """Return the finding of the author's function. Raises ManifestError, with the line, for an error in it."""
    file, _, name = parameters.text("function").partition(":")
    path = (parameters.folder or Path()) / file
    if not name or Path(file).name != file:
        parameters.refuse("function", "FILE.py:FUNCTION, with a file in the exercise's own folder")
    if not path.is_file():
        raise ManifestError(f"{parameters.where}: function names {path}, which does not exist")
    given = parameters.rest()
    try:
        names = runpy.run_path(str(path))
    except Exception as error:
        raise ManifestError(f"{_place(error, path)}: {type(error).__name__}: {error}") from None
    if not callable(names.get(name)):
        known = [key for key, value in names.items() if callable(value) and not key.startswith("_")]
        hint = did_you_mean(name, known, listing="known")
        raise ManifestError(f"{parameters.where}: {path} has no function {name!r}{hint}")
    try:
        finding: Any = names[name](recording, given)
    except Exception as error:
        raise ManifestError(f"{_place(error, path)}: {type(error).__name__}: {error}") from None
    if not isinstance(finding, Finding):
        raise ManifestError(f"{path}: {name}() must return a Finding, not {finding!r}"[:300])
    return finding


def _place(error: Exception, path: Path) -> str:
    """Return the author's file and line in which an error was raised."""
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
    line = lines[-1] if lines else getattr(error, "lineno", None)
    return f"{path}, line {line}" if line else str(path)
