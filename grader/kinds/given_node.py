"""The node that comes with an exercise, beside its manifest."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gz_course.grader.errors import ManifestError

if TYPE_CHECKING:
    from gz_course.grader.exercise import Exercise

EXERCISE_NODE = "given_node.py"  # beside the manifest
APART = ".exercise"  # folder of it beside the packages of a submission, no file of which has such a name


def exercise_node(exercise: Exercise) -> dict[str, bytes]:
    """Return the node that comes with an exercise, as files for the sandbox. Raises ManifestError if there is none."""
    try:
        return {EXERCISE_NODE: (exercise.folder / EXERCISE_NODE).read_bytes()}
    except OSError as error:
        raise ManifestError(
            f"{exercise.folder} has no {EXERCISE_NODE}, the exercise's own node: {error.strerror}"
        ) from None
