"""The trial of a recording that is scored again: as the exercise has it now, else as the recording keeps it."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

from gz_course.grader.exercise.conditions import conditions_sha256
from gz_course.grader.exercise.exercise import Exercise
from gz_course.grader.exercise.trial import TRIALS, Trial, load_trials, refuse_unknown_checks


def recorded_trial(exercise: Exercise, run: dict[str, Any]) -> Trial:
    """Return the trial of a run, of which the recording keeps the properties `run`.

    What a trial changes of checks is part of the checks, so that of the exercise counts, if it still has the trial.
    Raises ManifestError if that changes a check that does not exist.
    """
    name = run.get("trial", "public")
    hidden = exercise.twin / TRIALS
    for each in exercise.trials + (load_trials(hidden) if hidden.is_file() else ()):
        if each.name == name and run.get("conditions_sha256") == conditions_sha256(each.applied_to(exercise), each):
            refuse_unknown_checks((each,), exercise.checks)
            return each
    changed = json.loads(run.get("trial_checks") or "{}")
    known = {check.id for check in exercise.checks}
    kept = {id: parameters for id, parameters in changed.items() if id in known}
    return replace(Trial(name, 0), checks=kept, weight=run.get("trial_weight"))
