"""Runs in which the exercise's own node drives the robots, and the submission is a file about the two graphs.

Shared by the kinds `table` and `bridge`. What that node does is never the student's fault.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gz_course.grader.errors import ManifestError

if TYPE_CHECKING:
    from gz_course.grader.exercise import Exercise
    from gz_course.grader.record.reading import Recording
    from gz_course.grader.run.run_loop import RunLoop
    from gz_course.grader.score.diagnosis import Diagnosis

EXERCISE_NODE = "given_node.py"  # beside the manifest


def exercise_node(exercise: Exercise) -> dict[str, bytes]:
    """Return the node that comes with an exercise, as files for the box. Raises ManifestError if there is none."""
    try:
        return {EXERCISE_NODE: (exercise.folder / EXERCISE_NODE).read_bytes()}
    except OSError as error:
        raise ManifestError(
            f"{exercise.folder} has no {EXERCISE_NODE}, the node that plays in it: {error.strerror}"
        ) from None


def run_loop() -> type[RunLoop]:
    """Import what simulates such a run, with rclpy and MuJoCo."""
    from gz_course.grader.kinds.exercise_node_run_loop import ExerciseNodeRunLoop

    return ExerciseNodeRunLoop


def diagnosis() -> Diagnosis:
    """Explain runs by the load that the submission's bridges make, and by nothing the node does."""
    from gz_course.grader.score import diagnosis as looks

    return looks.Diagnosis(outcome, (looks.cannot_run, too_much, looks.unstable))


def outcome(recording: Recording) -> str:
    """Return `student_error` for a file of no use, `timeout` for one that holds everything up, or `graded`."""
    facts = recording.facts()
    return "student_error" if facts.get("fault") else "timeout" if too_much(recording, facts) else "graded"


def too_much(recording: Recording, facts: dict[str, Any]) -> str:
    """Say that the run took too long, and when it was ended."""
    if not facts.get("out_of_time"):
        return ""
    return (
        f"The run took too long and was ended at {facts['sim_seconds']:.2f} s of simulated time: your bridges carry "
        "far more than is asked for."
    )
