"""The facts about a run as a whole, as properties of its recording."""

from __future__ import annotations

import json
from importlib.metadata import version
from typing import Any

from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.conditions import conditions_sha256
from gz_course.grader.exercise.trial import Trial
from gz_course.grader.printable import shown
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.submission import Submission

PACKAGES = {"mujoco": "mujoco", "rclpy": "ros-jazzy-rclpy", "rerun": "rerun-sdk", "course": "gz-ros2-course"}


def write_properties(
    recorder: Recorder, exercise: Exercise, submission: Submission, trial: Trial, facts: dict[str, Any]
) -> None:
    """Store what was graded, with which parameters and versions, and what became of the node (`facts`)."""
    recorder.title(_title(exercise, submission, trial))
    recorder.properties(
        "run",
        exercise=exercise.name,
        submission=shown(submission.main),
        submission_sha256=submission.sha256,
        manifest_sha256=exercise.manifest_sha256,
        conditions_sha256=conditions_sha256(exercise, trial),
        seed=trial.seed,
        trial=trial.name,
        trial_number=trial.place[0],
        trial_count=trial.place[1],
        trial_parameters=json.dumps(trial.as_dict(), sort_keys=True, default=str),
        duration=exercise.duration,
        robot=exercise.robot,
        facts=json.dumps(facts, sort_keys=True),
        **_for_scoring(trial),
    )
    recorder.properties("versions", **{name: version(package) for name, package in PACKAGES.items()})


def _for_scoring(trial: Trial) -> dict[str, Any]:
    """Return what a trial brings for the checks alone, where it does."""
    told = {"trial_checks": trial.checks, "trial_private": trial.private}
    found: dict[str, Any] = {name: json.dumps(each, sort_keys=True, default=str) for name, each in told.items() if each}
    return found if trial.weight is None else found | {"trial_weight": trial.weight}


def _title(exercise: Exercise, submission: Submission, trial: Trial) -> str:
    title = f"{exercise.title}: {shown(submission.main)}"
    return title if trial.place[1] == 1 else f"{title}, {trial.name}"
