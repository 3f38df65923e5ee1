"""The node that comes with an exercise: beside its manifest, or in its folder if students read it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from gz_course.grader.errors import ManifestError

if TYPE_CHECKING:
    from gz_course.grader.exercise import Exercise

EXERCISE_NODE = "given_node.py"
APART = ".exercise"  # folder of it beside the packages of a submission, no file of which has such a name


def node_file(exercise: Exercise) -> Path:
    """Return the file of the node, whether it is there or not."""
    hidden = exercise.grading / EXERCISE_NODE
    return hidden if hidden.is_file() else exercise.folder / EXERCISE_NODE


def exercise_node(exercise: Exercise) -> dict[str, bytes]:
    """Return the node that comes with an exercise, as files for the sandbox. Raises ManifestError if there is none."""
    try:
        return {EXERCISE_NODE: node_file(exercise).read_bytes()}
    except OSError as error:
        raise ManifestError(
            f"{exercise.folder} has no {EXERCISE_NODE}, the exercise's own node: {error.strerror}"
        ) from None
