"""`kind = "launch"`: the submission is a launch file that starts simulator, bridge and nodes itself.

It is started with `ros2 launch`, in the folder that also holds what comes with the exercise (every file beside the
manifest). The `parameters` of a trial are its arguments: `parameters = { paused = "true" }` is `paused:=true`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gz_course.grader.kinds.kind import Cast, Kind
from gz_course.grader.kinds.node import fault

if TYPE_CHECKING:
    from gz_course.grader.exercise import Exercise
    from gz_course.grader.submission import Submission


def cast(exercise: Exercise, submission: Submission) -> Cast:
    """The launch file, with what comes with the exercise beside it."""
    own = (exercise.file, MANIFEST)
    given = [path for path in exercise.folder.iterdir() if path.is_file() and path.name not in own]
    return Cast(submission.main, submission.files | {path.name: path.read_bytes() for path in given}, launch=True)


MANIFEST = "exercise.toml"
KIND = Kind((".py",), fault, cast, brings_bridge=True, brings_world=True)
