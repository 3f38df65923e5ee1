"""Grades one submission: intake, run, record, score the recording, report. The whole life of a grade in one place."""

from __future__ import annotations

import time
from pathlib import Path

from grader.errors import UsageError
from grader.exercise import Exercise, find_exercise
from grader.intake import take_in
from grader.printable import shown
from grader.record.reading import Recording
from grader.report.report import HostFacts, Report, TrialReport
from grader.report.verdicts import write_verdicts
from grader.score.score import Score, score
from grader.trial import Trial

LONGEST_PATH = 4096
PACES = ("lockstep", "realtime")


def grade(
    exercise: Exercise,
    submission_path: Path | None,
    out: Path,
    *,
    seed: int = 0,
    pace: str = "lockstep",
    started: float | None = None,
) -> Report:
    """Grade the submission at a path (None: the student's own copy) and leave its recording in the folder `out`.

    `started` is the `time.monotonic()` [s] at which the command began, for the report. Raises UsageError for a
    submission that cannot be read; a submission that is wrong is graded, not raised.
    """
    started = time.monotonic() if started is None else started
    submission = take_in(exercise, submission_path)
    trial = Trial("public", seed)
    path = out / f"{exercise.name}.rrd"

    from grader.run.session import record_unrunnable, run

    if submission.fault is None:
        result = run(exercise, submission, trial, pace, path)
    else:
        result = record_unrunnable(exercise, submission, trial, path)
    with result.recorder as recorder:
        recorder.flush()
        recording = Recording(recorder.part)
        verdict = score(recording, exercise)
        write_verdicts(recorder, verdict, exercise.max_score, exercise.duration)
    host = HostFacts(result.sandbox, result.pace, result.run_wall_seconds, time.monotonic() - started)
    return make_report(recording, path, exercise, verdict, shown(str(submission.path), LONGEST_PATH), host)


def grade_again(path: Path, root: Path | None = None) -> Report:
    """Score a recording once more; the same score as the first time, unless the exercise has changed since."""
    recording = Recording(path)
    run = recording.properties("run")
    if "exercise" not in run:
        raise UsageError(f"{path} is not a recording of a graded run")
    exercise = find_exercise(run["exercise"], root)
    return make_report(recording, path, exercise, score(recording, exercise), run["submission"])


def make_report(
    recording: Recording, path: Path, exercise: Exercise, verdict: Score, submission: str, host: HostFacts | None = None
) -> Report:
    """Put a score and what the recording, which people find at `path`, says about its run together."""
    run = recording.properties("run")
    return Report(
        exercise=exercise.name,
        title=exercise.title,
        submission=submission,
        recording=path,
        score=verdict,
        max_score=exercise.max_score,
        sim_seconds=recording.facts().get("sim_seconds", 0.0),
        seed=run["seed"],
        versions=recording.properties("versions"),
        host=host,
        trials=(TrialReport("public", run["seed"], verdict, path, verdict.truth_sha256),),
    )
