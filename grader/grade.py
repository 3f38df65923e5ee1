"""The life of a grade in one place: intake, run, record, score the recording, report."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise, exercise_names, find_exercise
from gz_course.grader.exercise.recorded_trial import recorded_trial
from gz_course.grader.exercise.trial import Trial, numbered, with_parameters
from gz_course.grader.exercise.visibility import NEVER
from gz_course.grader.printable import shown
from gz_course.grader.process.output_lock import sole_writer
from gz_course.grader.record.reading import Recording
from gz_course.grader.report.ranking import places
from gz_course.grader.report.report import HostFacts, Report, TrialReport
from gz_course.grader.report.seen import rules_of
from gz_course.grader.run.limits import limits_of
from gz_course.grader.run.supervision import Heartbeat, Supervised
from gz_course.grader.score.check_fault import CheckFault, left_behind
from gz_course.grader.score.combined import combined
from gz_course.grader.score.score import Score, score
from gz_course.grader.submission import Submission
from gz_course.grader.submission.intake import take_in

LONGEST_PATH = 4096
PACES = ("lockstep", "realtime")


@dataclass(frozen=True)
class TrialResult:
    """One trial, run and scored. `host` is None when it was scored from its recording alone."""

    recording: Recording
    path: Path
    score: Score
    host: HostFacts | None = None
    weight: float | None = None  # of the trial

    @property
    def run(self) -> dict[str, Any]:
        """What the recording says about its run: exercise, submission, trial, seed."""
        return self.recording.properties("run")


def grade(
    exercise: Exercise,
    submission_path: Path | None,
    out: Path,
    *,
    seed: int = 0,
    pace: str = "lockstep",
    trials: tuple[Trial, ...] | None = None,
    sandbox: str = "auto",
    explained: bool = True,
    started: float | None = None,
    meanwhile: Callable[[], object] = lambda: None,
) -> Report:
    """Grade the submission at a path (None: the student's own copy) and leave its recordings in the folder `out`.

    `trials` are those of the exercise if None; `seed` is added to the seed of each. `sandbox` is a
    level of `grader.run.sandbox`. Without `explained` the files are not read for likely mistakes. `started` is the
    `time.monotonic()` [s] at which the command began, for the report; `meanwhile` is called once while a run goes on in
    another process.
    Raises UsageError for a submission that cannot be read, and if another grader writes into `out` at this moment; a
    submission that is wrong is graded, not raised.
    """
    started = time.monotonic() if started is None else started
    submission = take_in(exercise, submission_path, explained=explained)
    asked = numbered(trials or exercise.trials, seed)
    with sole_writer(out, exercise.name):
        runs = [_TrialRun(exercise, submission, trial, pace, out, sandbox) for trial in asked]
        results = _run_supervised(runs, meanwhile) if submission.fault is None else [each(Heartbeat()) for each in runs]
    facts = [each.host for each in results if each.host is not None]
    host = HostFacts(
        "; ".join(dict.fromkeys(each.sandbox for each in facts)),
        "; ".join(dict.fromkeys(each.pace for each in facts)),
        sum(each.run_wall_seconds for each in facts),
        time.monotonic() - started,
        limits_of(exercise.duration, exercise.kind == "launch"),
    )
    return make_report(results, exercise, shown(str(submission.path), LONGEST_PATH), host, notes=submission.notes)


@dataclass(frozen=True)
class _TrialRun:
    """A call of `run_trial` that another process can make. `outcome` is that of a submission with a fault."""

    exercise: Exercise
    submission: Submission
    trial: Trial
    pace: str
    out: Path
    sandbox: str
    outcome: str = "student_error"

    def __call__(self, heartbeat: Heartbeat) -> TrialResult:
        return run_trial(
            self.exercise, self.submission, self.trial, self.pace, self.out, self.sandbox, heartbeat, self.outcome
        )


def _run_supervised(runs: Sequence[_TrialRun], meanwhile: Callable[[], object]) -> list[TrialResult]:
    """Run trials in a supervised child process; the recording of one that had to be ended holds only the reason."""
    results: list[TrialResult] = []
    while len(results) < len(runs):
        left = runs[len(results) :]
        try:
            done, broken = Supervised(left, left[0].exercise.duration, meanwhile).run()
        except BaseException:
            for each in left:  # a child that was killed leaves the recording it had begun
                path = recording_path(each.exercise, each.trial, each.out)
                path.with_name(f"{path.name}.part").unlink(missing_ok=True)
            raise
        results += done
        if broken is not None:
            each = runs[len(results)]
            fault = replace(each.submission, fault=broken.sentence)
            ended = replace(each, submission=fault, outcome=broken.outcome)
            results += Supervised([ended], each.exercise.duration).run()[0]
    return results


def run_trial(
    exercise: Exercise,
    submission: Submission,
    trial: Trial,
    pace: str,
    out: Path,
    sandbox: str = "auto",
    heartbeat: Heartbeat | None = None,
    outcome: str = "student_error",
) -> TrialResult:
    """Run one trial of a submission and score its recording, which is left in the folder `out`.

    `heartbeat` is told how far it has come; `outcome` is that of a submission with a fault.
    """
    from gz_course.grader.run.session import record_unrunnable, run

    path = recording_path(exercise, trial, out)
    in_trial = trial.applied_to(exercise)
    if submission.fault is None:
        result = run(in_trial, submission, trial, pace, path, sandbox, heartbeat)
    else:
        result = record_unrunnable(in_trial, submission, trial, path, outcome)

    from gz_course.grader.report.verdicts import write_verdicts  # not before the submission starts up

    verdict: Score | CheckFault
    with result.recorder as recorder:
        recorder.flush()
        recording = Recording(recorder.part)
        try:
            verdict = score(recording, in_trial)
        except CheckFault as fault:  # the run is what the author needs to find it
            verdict = fault
        else:
            write_verdicts(recorder, verdict, exercise.max_score, in_trial.duration)
    if isinstance(verdict, CheckFault):
        raise left_behind(verdict, path)
    host = HostFacts(result.sandbox, result.pace, result.run_wall_seconds, 0.0)
    return TrialResult(recording, path, verdict, host, trial.weight)


def recording_path(exercise: Exercise, trial: Trial, out: Path) -> Path:
    """Return where a trial's recording goes: `NAME.rrd`, or `NAME.TRIAL.rrd` if there are several trials."""
    return out / (f"{exercise.name}.rrd" if trial.place[1] == 1 else f"{exercise.name}.{trial.name}.rrd")


def grade_again(paths: Path | Sequence[Path], root: Path | None = None) -> Report:
    """Score recordings once more: that of one trial, or those of all trials of one grading, in any order.

    The same score as the first time, unless the exercise has changed since. A folder stands for the recordings in it.
    Raises UsageError for recordings that do not belong together.
    """
    folders = [paths] if isinstance(paths, Path) else list(paths)
    recordings = [(path, Recording(path)) for each in folders for path in recordings_in(each)]
    runs = [recording.properties("run") for _, recording in recordings]
    for (path, _), run in zip(recordings, runs, strict=True):
        if "exercise" not in run:
            raise UsageError(f"{path} is not a recording of a graded run")
    _check_trials([path for path, _ in recordings], runs)
    exercise = find_exercise(runs[0]["exercise"], root)
    results = [_scored(recording, exercise, path) for path, recording in recordings]
    results.sort(key=lambda each: each.run.get("trial_number", 1))
    notes = []
    if any(run.get("manifest_sha256", exercise.manifest_sha256) != exercise.manifest_sha256 for run in runs):
        notes.append(f"The manifest of {exercise.name} has changed since this run; it is scored by what it says now.")
    if len(runs) == 1 and runs[0].get("trial_count", 1) > 1:
        notes.append(
            f"This is the trial {runs[0]['trial']} alone, one of {runs[0]['trial_count']} of its grading; give the "
            "folder of all recordings for the score that counts."
        )
    return make_report(results, exercise, runs[0]["submission"], notes=notes)


def _scored(recording: Recording, exercise: Exercise, path: Path) -> TrialResult:
    trial = recorded_trial(exercise, recording.properties("run"))
    try:
        found = score(recording, replace(exercise, checks=with_parameters(exercise.checks, trial.checks)))
        return TrialResult(recording, path, found, weight=trial.weight)
    except CheckFault as fault:
        raise left_behind(fault, path) from fault


def recordings_in(path: Path) -> list[Path]:
    """Return the recordings a path stands for: itself, or those of a folder. Raises UsageError if it holds none."""
    if not path.is_dir():
        return [path]
    if found := sorted(path.glob("*.rrd")):
        return found
    raise UsageError(f"there is no recording (.rrd) in the folder {path}")


def _check_trials(paths: list[Path], runs: list[dict[str, Any]]) -> None:
    """Raise UsageError unless the recordings are one trial, or all trials of one grading."""
    if len(runs) == 1:
        return
    for path, run in zip(paths, runs, strict=True):
        for key, noun in (("exercise", "exercise"), ("submission_sha256", "submission"), ("trial_count", "grading")):
            if run.get(key) != runs[0].get(key):
                raise UsageError(f"{path} and {paths[0]} are of different {noun}s; give the recordings of one grading")
    names = [run.get("trial", "public") for run in runs]
    for name in names:
        if names.count(name) > 1:
            raise UsageError(
                f"two of these recordings are of the same trial, {name}; give the recordings of one grading"
            )
    if len(runs) != (count := runs[0].get("trial_count", 1)):
        raise UsageError(
            f"these are {len(runs)} of {count} trials ({', '.join(names)}); give all recordings of the grading, or one"
        )


def _after(exercise: Exercise) -> tuple[str, ...]:
    """Return what to say after full marks: other ways, what to try, and the next exercise of the course."""
    said = []
    if exercise.other_ways:
        said.append(f"Other ways: {'; '.join(exercise.other_ways)}.")
    if exercise.further:
        said.append(f"Try next: {exercise.further}")
    names = exercise_names(exercise.folder.parents[1])
    if exercise.name in names[:-1]:
        said.append(f"The next exercise is {names[names.index(exercise.name) + 1]}.")
    return tuple(said)


def make_report(
    results: Sequence[TrialResult],
    exercise: Exercise,
    submission: str,
    host: HostFacts | None = None,
    notes: Sequence[str] = (),
) -> Report:
    """Put the scores of all trials, and what their recordings say about the runs, together."""
    if any(each.recording.facts().get("lines_dropped") for each in results):
        notes = [*notes, "The log was too long to be recorded as a whole; it was cut, and that costs no points."]
    visible = rules_of(exercise).trials
    weights = [each.weight for each in results]
    score = combined([(each.run.get("trial", "public"), each.score) for each in results], weights)
    return Report(
        exercise=exercise.name,
        title=exercise.title,
        submission=submission,
        recording=results[0].path,
        score=score,
        max_score=exercise.max_score,
        sim_seconds=sum(each.recording.facts().get("sim_seconds", 0.0) for each in results),
        seed=results[0].run["seed"],
        versions=results[0].recording.properties("versions"),
        host=host,
        trials=tuple(
            TrialReport(
                each.run.get("trial", "public"),
                each.run["seed"],
                each.score,
                each.path,
                each.score.truth_sha256,
                each.recording,
                visible.get(each.run.get("trial", "public"), NEVER),
            )
            for each in results
        ),
        leaderboard=places(exercise.leaderboard, [each.score for each in results]),
        notes=(*notes, *score.faults),
        hints_shown=exercise.hints_shown,
        after=_after(exercise),
        untouched=bool(results[0].recording.facts().get("untouched")),
    )
