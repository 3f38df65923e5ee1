"""Runs in which the exercise's own node drives the robots, and the submission is a file about the two graphs.

Shared by the kinds `table` and `bridge`. A fault of that node never costs the student points.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gz_course.grader.record.reading import Recording
    from gz_course.grader.run.run_loop import RunLoop
    from gz_course.grader.score.diagnosis import Diagnosis


def run_loop() -> type[RunLoop]:
    """Import the class that simulates such a run, which needs rclpy and MuJoCo."""
    from gz_course.grader.kinds.exercise_node_run_loop import ExerciseNodeRunLoop

    return ExerciseNodeRunLoop


def diagnosis() -> Diagnosis:
    """Explain runs by what the submission's bridges publish; the exercise's own node is never blamed."""
    from gz_course.grader.score import diagnosis as looks

    return looks.Diagnosis(outcome, (unreadable, too_much, looks.unstable))


def unreadable(recording: Recording, facts: dict[str, Any]) -> str:
    """Return why nothing can be made of the file, and what was mistaken in it."""
    from gz_course.grader.feedback.errors.launch_errors import bridge_meaning
    from gz_course.grader.score.diagnosis import cannot_run

    why = bridge_meaning(str(facts.get("fault") or ""))
    return f"{facts['fault']}. What that means: {why}." if why else cannot_run(recording, facts)


def outcome(recording: Recording) -> str:
    """Return `student_error` for an unusable file, `timeout` for one that delays the run too long, else `graded`."""
    facts = recording.facts()
    return "student_error" if facts.get("fault") else "timeout" if too_much(recording, facts) else "graded"


def too_much(recording: Recording, facts: dict[str, Any]) -> str:
    """Return that the run took too long, and when it was ended."""
    if not facts.get("out_of_time"):
        return ""
    return (
        f"The run took too long and was ended at {facts['sim_seconds']:.2f} s of simulated time: your bridges carry "
        "far more than is asked for."
    )
