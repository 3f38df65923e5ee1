"""What is wrong in a manifest, found without a run: `course list` and `course verify` name it.

Each check is applied to a recording in which nothing happened: it reads its parameters, so a typing mistake shows. A
function of the author is looked for, not called.
"""

from __future__ import annotations

import json
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import CheckSpec, Exercise, find_exercise
from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.exercise.trial import TRIALS, ScriptedCall, chosen_trials
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kinds, perform, perform_all
from gz_course.grader.score.checks.python import author_function
from gz_course.grader.score.partial import VALUES
from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.interface import interface_names, prototype

NOTHING_SEEN = Finding(True, "anything", "nothing was looked at")


class NothingHappened(Recording):
    """A recording of the exercise without a single sample."""

    def __init__(self, exercise: Exercise) -> None:
        self.path = exercise.manifest
        self._rows: dict[tuple[str, str], list[tuple[Any, Any]]] = {}
        self._static: dict[str, dict[str, Any]] = defaultdict(dict)
        parameters = {"poses": {}, "parameters": exercise.trials[0].parameters}
        self._run = {
            "exercise": exercise.name,
            "duration": exercise.duration,
            "seed": 0,
            "robot": exercise.robot,
            "trial_parameters": json.dumps(parameters, default=str),
        }

    def properties(self, name: str) -> dict[str, Any]:
        """Return the facts of a run that saw nothing."""
        return self._run if name == "run" else {}


def manifest_faults(exercise: Exercise) -> list[str]:
    """Return a sentence for each mistake in the checks and message types of a manifest."""
    found = [*_types(exercise), *_calls(exercise), *_checks(exercise), *_ranked(exercise)]
    hidden = (exercise.twin / TRIALS).is_file()
    for trial in chosen_trials(exercise, "all" if hidden else "public"):
        if trial.checks or trial.script:
            changed = trial.applied_to(exercise)
            there = [each for each in (*_calls(changed), *_checks(changed)) if each not in found]
            found += [f"in the trial {trial.name!r}: {each}" for each in there]
    found = list(dict.fromkeys(found))
    return [each if each.startswith(str(exercise.folder)) else f"{exercise.manifest}: {each}" for each in found]


def _types(exercise: Exercise) -> Iterator[str]:
    known: list[str] = []
    for topic, ros_type in exercise.observe.items():
        known = known or interface_names("msg")
        if ros_type not in known:
            hint = did_you_mean(ros_type, known)
            yield f"observe: {topic} is of type {ros_type!r}, which is no message type here{hint}"


def _calls(exercise: Exercise) -> Iterator[str]:
    """Yield the types of services that no package has, and requests with fields that the type lacks."""
    for each in exercise.script:
        if isinstance(each, ScriptedCall):
            known = interface_names("srv")
            if each.type not in known:
                yield f"the call of {each.service}: there is no type {each.type!r}{did_you_mean(each.type, known)}"
                continue
            fields = list(prototype(each.type).get_fields_and_field_types())
            for name in sorted(each.request.keys() - set(fields)):
                hint = did_you_mean(name, fields, listing="known")
                yield f"the call of {each.service}: the request of {each.type} has no field {name!r}{hint}"


def _checks(exercise: Exercise) -> Iterator[str]:
    nothing = NothingHappened(exercise)
    known = [spec.id for spec in exercise.checks]

    def applied(spec: CheckSpec, other: Any) -> Finding:
        kind = check_kinds().get(spec.kind)
        return perform(spec, nothing, exercise.grading, other, _looked_for if spec.kind == "python" else kind)

    fine = True
    for spec in exercise.checks:
        try:
            applied(spec, lambda id, spec=spec: _named(id, spec, known))
        except ManifestError as error:
            fine = False
            yield str(error)
    if fine:
        try:
            perform_all(exercise.checks, nothing, exercise.grading, lambda spec, _, __, other: applied(spec, other))
        except ManifestError as error:
            yield str(error)


def _ranked(exercise: Exercise) -> Iterator[str]:
    """Yield the checks of the leaderboard that measure no number."""
    kinds = {spec.id: spec.kind for spec in exercise.checks}
    for ranked in exercise.leaderboard:
        if (kind := kinds[ranked.check]) not in VALUES:
            measuring = ", ".join(VALUES)
            yield f"leaderboard {ranked.name!r}: a check of kind {kind!r} measures no number; these do: {measuring}"


def _named(id: str, spec: CheckSpec, known: list[str]) -> Finding:
    if id not in known:
        hint = did_you_mean(id, known, listing="known")
        raise ManifestError(f"check {spec.id!r}: its gate names no check: {id!r}{hint}")
    return NOTHING_SEEN


def _looked_for(recording: Recording, parameters: Table) -> Finding:
    """Look for an author's function, without calling it."""
    author_function(parameters)
    parameters.rest()
    return NOTHING_SEEN


def main() -> None:
    """Print the mistakes in the exercises of a course, given its folder and their names, as JSON."""
    root, *names = sys.argv[1:]
    print(json.dumps([fault for name in names for fault in manifest_faults(find_exercise(name, Path(root)))]))


if __name__ == "__main__":
    main()
