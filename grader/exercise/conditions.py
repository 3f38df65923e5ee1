"""What a run depends on besides the submission: a recording of other conditions cannot be scored as one of these."""

from __future__ import annotations

import hashlib
from pathlib import Path

from gz_course.grader.exercise.exercise import Exercise
from gz_course.grader.exercise.trial import Trial

DECIDES = ("kind", "file", "files", "robot", "duration", "tick", "real_time_factor", "observe", "bridge_parameters")


def conditions_sha256(exercise: Exercise, trial: Trial) -> str:
    """Return the SHA-256 of what a run of `exercise`, with the trial applied to it, depends on, but for the seed."""
    total = hashlib.sha256(repr([getattr(exercise, name) for name in DECIDES]).encode())
    world = Path(exercise.world)
    total.update(world.read_bytes() if world.is_file() else exercise.world.encode())
    if exercise.bridge is not None:
        total.update(exercise.bridge.read_bytes())
    total.update(repr((exercise.script, trial.as_dict())).encode())
    return total.hexdigest()
