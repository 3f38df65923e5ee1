"""`python`: a function in the exercise's folder `grading`, for checks that no other kind can express.

kind = "python"
function = "checks.py:drives_in_circles"     # a file beside the manifest, and the function in it
turns = 2                 # every other parameter is passed to the function unchanged

    def drives_in_circles(recording, parameters):
        yaw = recording.signal("truth/robot/yaw").values
        turned = abs(yaw[-1]) / 6.28 if len(yaw) else 0.0
        wanted = parameters["turns"]
        return Finding(turned >= wanted, expected=f"{wanted} turns", measured=f"{turned:.1f} turns")

`docs/recordings.md` lists what `recording` and `Finding` offer; `recording.parameters` are those of the trial. The
folder is a package: a file imports another with `from .other import name`. It is the author's and runs in the grader's
own process. A function must use nothing but its arguments, so that a score can be computed again. If it raises an
error, the recording stays, and beside it the traceback from the author's line on.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise.grading import grading_module
from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.check_fault import CheckFault, from_authors_line
from gz_course.sim.did_you_mean import did_you_mean


def author_function(parameters: Table) -> tuple[Path, Callable[..., Any]]:
    """Return the file and the function that a check names. Raises ManifestError if there is none."""
    file, _, name = parameters.text("function").partition(":")
    path = (parameters.folder or Path()) / file
    if not name or Path(file).name != file:
        parameters.refuse("function", "FILE.py:FUNCTION, with a file in the exercise's own folder `grading`")
    if not path.is_file():
        raise ManifestError(f"{parameters.where}: function names {path}, which does not exist")
    try:
        module = grading_module(path.parent, path.stem)
    except Exception as error:
        raise _fault(error, path) from error
    if not callable(getattr(module, name, None)):
        known = [key for key, value in vars(module).items() if callable(value) and not key.startswith("_")]
        hint = did_you_mean(name, known, listing="known")
        raise ManifestError(f"{parameters.where}: {path} has no function {name!r}{hint}")
    return path, getattr(module, name)


@check_kind("python")
def python(recording: Recording, parameters: Table) -> Finding:
    """Return the finding of the author's function. Raises CheckFault, with the line, for an error in it."""
    path, function = author_function(parameters)
    given = parameters.rest()
    try:
        finding: Any = function(recording, given)
    except Exception as error:
        raise _fault(error, path) from error
    if not isinstance(finding, Finding):
        raise CheckFault(f"{path}: {function.__name__}() must return a Finding, not {finding!r}"[:300])
    return finding


def _fault(error: Exception, path: Path) -> CheckFault:
    return CheckFault(f"{_place(error, path)}: {type(error).__name__}: {error}", from_authors_line(error, path.parent))


def _place(error: Exception, path: Path) -> str:
    """Return the author's file and line in which an error was raised; `path` is the file that the manifest names."""
    if isinstance(error, SyntaxError) and error.filename:
        return f"{error.filename}, line {error.lineno}"
    frames = traceback.extract_tb(error.__traceback__)
    places = [f"{frame.filename}, line {frame.lineno}" for frame in frames if _beside(frame.filename, path)]
    return places[-1] if places else str(path)


def _beside(file: str, path: Path) -> bool:
    return Path(file).parent.resolve() == path.parent.resolve()
