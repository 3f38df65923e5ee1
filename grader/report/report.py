"""The report on one grading: everything that `--json` writes.

Programs read the keys (README, "The JSON report"): keys may be added but never renamed.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.grader.exercise.visibility import ALWAYS
from gz_course.grader.printable import storable
from gz_course.grader.report.ranking import Place

if TYPE_CHECKING:
    from gz_course.grader.record.reading import Recording
    from gz_course.grader.score.consequences import CheckResult
    from gz_course.grader.score.score import Score

# The meaning of each outcome in a sentence.
OUTCOMES = {
    "graded": "The submission ran to the end and was graded.",
    "student_error": "The submission could not run, or ended with an error.",
    "timeout": "The submission never became ready, or delayed the run too long.",
    "memory": "The submission ran out of memory.",
    "protocol": "The submission closed its connection to the grader.",
    "tamper": "The submission published what only the simulator may; nothing counts.",
    "infra": "The machine or the grader failed; this is no verdict on the program.",
}


@dataclass(frozen=True)
class HostFacts:
    """Facts known only while a run is graded; absent when a recording is scored again."""

    sandbox: str
    pace: str
    run_wall_seconds: float
    wall_seconds: float
    limits: Mapping[str, float] = field(default_factory=dict)  # [s] for one run: `processor_seconds`, `wall_seconds`


@dataclass(frozen=True)
class TrialReport:
    """One run of the submission: the trial's name and seed, the score of this run alone, and its recording.

    `read` is the content of the recording if it has been read already; `content()` reads it otherwise.
    """

    name: str
    seed: int
    score: Score
    recording: Path
    truth_sha256: str
    read: Recording | None = field(default=None, repr=False, compare=False)
    visibility: str = ALWAYS

    def __getstate__(self) -> dict[str, Any]:
        """Leave the content behind when a report goes to another process: its file has it."""
        return self.__dict__ | {"read": None}

    def content(self) -> Recording:
        """Return the recording. Raises UsageError if it cannot be read."""
        from gz_course.grader.record.reading import Recording

        return Recording(self.recording) if self.read is None else self.read


@dataclass(frozen=True)
class Report:
    """A score with its context. `score` is that of all `trials` together, `recording` that of the first."""

    exercise: str
    title: str
    submission: str
    recording: Path
    score: Score
    max_score: float
    sim_seconds: float
    seed: int
    versions: dict[str, Any]
    host: HostFacts | None = None
    trials: tuple[TrialReport, ...] = ()
    hints_shown: int = 1  # of a check, at most
    after: tuple[str, ...] = ()  # sentences for full marks: other ways, what to try, the next exercise
    untouched: bool = False  # the submission is the starter
    tried: bool = False  # whether a search for what helps has been made
    leaderboard: tuple[Place, ...] = ()  # the numbers by which a class is ranked, as far as they count
    notes: tuple[str, ...] = ()  # what a reader must know about the origin of the score

    @property
    def full_marks(self) -> bool:
        """Whether every point was earned."""
        return self.score.points >= self.max_score

    @property
    def measured(self) -> bool:
        """Whether the checks were applied: the submission could be run, and its behaviour counts."""
        return bool(self.sim_seconds) and self.score.outcome != "tamper"

    @property
    def shown_trial(self) -> TrialReport:
        """The trial to show: the first that lost points, else the first."""
        return next((trial for trial in self.trials if trial.score.points < self.max_score), self.trials[0])

    @property
    def first_failed(self) -> CheckResult | None:
        """The failed check to begin with: that which no other check gates, and of these the one worth most."""
        failed = [check for check in self.score.checks if not check.finding.passed]
        return max(failed, key=lambda check: (not check.finding.gated, check.spec.points), default=None)

    def told(self, check: CheckResult) -> list[tuple[str, str]]:
        """Return (name, text) pairs on one check: expected, measured, when, and the hint if it failed.

        Without a measurement there is no hint, because another fault must be mended first.
        """
        finding = check.finding
        lines = [("expected", finding.expected), ("measured", finding.measured)]
        if finding.at_s is not None:
            lines.append(("when", f"{finding.at_s:.2f} s of simulated time"))
        if check.kept:
            kept = f"{points(check.kept)} of {points(check.spec.points)}"
            why = check.why or "all checks together lose at most 40 % for one misconception"
            lines.append(("kept", f"{kept} points: {why}"))
        elif check.points and not finding.passed:
            earned = f"{points(check.points)} of {points(check.spec.points)}"
            lines.append(("earned", f"{earned} points: they fall with the distance from what was expected"))
        return [*lines, ("hint", check.spec.hint)] if self.measured and not finding.passed else lines

    def as_json(self) -> str:
        return json.dumps(storable(self.as_dict()), indent=2, allow_nan=False) + "\n"

    def as_dict(self) -> dict[str, Any]:
        """Return the report as plain data. Facts about the machine are null when a recording is scored again."""
        host = self.host
        run_wall = host.run_wall_seconds if host else None
        return {
            "exercise": self.exercise,
            "submission": self.submission,
            "score": self.score.points,
            "max_score": self.max_score,
            "outcome": self.score.outcome,
            "diagnosis": self.score.feedback,
            "first_sentence": self.score.diagnosis,
            "notes": list(self.notes),
            "leaderboard": [asdict(each) for each in self.leaderboard],
            "checks": [
                {
                    "id": check.spec.id,
                    "title": check.spec.title,
                    "points": check.points,
                    "max_points": check.spec.points,
                    "status": "passed" if check.finding.passed else "failed",
                    "expected": check.finding.expected,
                    "measured": check.finding.measured,
                    "at_s": check.finding.at_s,
                    "hint": None if check.finding.passed else check.spec.hint,
                }
                for check in self.score.checks
            ],
            "trials": [
                {
                    "name": trial.name,
                    "seed": trial.seed,
                    "score": trial.score.points,
                    "outcome": trial.score.outcome,
                    "recording": str(trial.recording),
                    "truth_sha256": trial.truth_sha256,
                    "diagnosis": trial.score.feedback,
                    "checks": [_finding(check) for check in trial.score.checks],
                }
                for trial in self.trials
            ],
            "sandbox": host.sandbox if host else None,
            "pace": host.pace if host else None,
            "recording": str(self.recording),
            "truth_sha256": self.score.truth_sha256,
            "sim_seconds": self.sim_seconds,
            "run_wall_seconds": run_wall,
            "wall_seconds": host.wall_seconds if host else None,
            "limits": dict(host.limits) if host else None,
            "real_time_factor": self.sim_seconds / run_wall if run_wall else None,
            "versions": self.versions,
        }


def _finding(check: CheckResult) -> dict[str, Any]:
    """Return what a check found in one trial."""
    finding = check.finding
    return {
        "id": check.spec.id,
        "status": "passed" if finding.passed else "failed",
        "expected": finding.expected,
        "measured": finding.measured,
        "at_s": finding.at_s,
    }


def points(value: float) -> str:
    """Return points as text without trailing zeros and without rounding errors of binary fractions."""
    return f"{round(value, 3):g}"
