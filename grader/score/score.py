"""The score of a recording by an exercise's manifest: a pure function of the two."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace

import numpy as np

from gz_course.grader.exercise import Exercise
from gz_course.grader.feedback.predictions.answers import agreed
from gz_course.grader.feedback.recorded.places import made_in
from gz_course.grader.feedback.rules import faults_kept, recorded_faults
from gz_course.grader.kinds.kind import find_kind
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, perform_all
from gz_course.grader.score.consequences import CheckResult, shared
from gz_course.grader.score.diagnosis import diagnose
from gz_course.grader.score.first_sentence import first_of
from gz_course.grader.score.topic_faults import silent

NOT_RUN = Finding(False, "a file that runs", "nothing was run")
SPOILT = Finding(False, "a run that nobody tampers with", "not counted: the run was tampered with")
TRUTH = ("x", "y", "z", "qw", "qx", "qy", "qz")


@dataclass(frozen=True)
class Score:
    """The score of one run. `diagnosis` is the first sentence of feedback and `details` the rest; empty for full marks.

    `faults` are sentences for the instructor on rules of feedback that failed.
    """

    checks: tuple[CheckResult, ...]
    outcome: str
    diagnosis: str
    truth_sha256: str
    details: str = ""
    faults: tuple[str, ...] = ()

    @property
    def feedback(self) -> str:
        """The diagnosis and its details."""
        return f"{self.diagnosis} {self.details}".strip(" ")

    @property
    def points(self) -> float:
        return sum(check.points for check in self.checks)


def score(recording: Recording, exercise: Exercise) -> Score:
    """Apply every check of the manifest and name the most likely fault."""
    with faults_kept() as faults:
        found = _score(recording, exercise)
    broken = dict.fromkeys([*recorded_faults(recording.facts()), *faults])
    return replace(found, faults=tuple(map(str, broken)))


def _score(recording: Recording, exercise: Exercise) -> Score:
    specs = exercise.checks
    explained = find_kind(exercise.kind).diagnosis()
    outcome = explained.outcome(recording)
    if recording.facts().get("fault"):
        findings = [NOT_RUN] * len(specs)
    elif outcome == "tamper":  # what was forged may be nothing that a check can read
        findings = [SPOILT] * len(specs)
    else:
        findings = _agreed(perform_all(specs, recording, exercise.grading))
    checks = shared(list(map(CheckResult, specs, findings)))
    failed = [check for check in checks if not check.finding.passed]
    if outcome == "timeout" and not failed:
        outcome = "graded"  # all that was asked for was seen, whatever could not be followed beside it
    # A check that names the misconception says more than that nothing was published.
    named = any(check.finding.explanation and not check.finding.gated for check in failed)
    title = ""
    diagnosis = diagnose(recording, (look for look in explained.looks if not (named and look is silent)))
    if failed and not diagnosis:
        worst = max(failed, key=lambda check: (not check.finding.gated, check.spec.points))
        remarks = [remark(recording, [check.finding for check in failed]) for remark in explained.remarks]
        seen, why = worst.finding.measured, worst.finding.explanation
        other = next((check for check in failed if check.finding.explanation and not check.finding.gated), None)
        if other is not None and not why:
            remarks.append(f"{other.spec.title}: {other.finding.explanation}.")
        said = f"{(title := worst.spec.title)}: {why or seen}."
        where = "" if why or any(remarks) else made_in(recording.facts())
        seen = f"Measured: {seen}." if why else ""
        diagnosis = " ".join(filter(None, (*remarks, said, where, seen)))
    first, details = first_of(diagnosis, title) if failed else ("", "")
    if failed and (begin := recording.facts().get("untouched")):
        first, details = str(begin), ""  # nothing is wrong yet
    return Score(checks, outcome, first, truth_sha256(recording, exercise.robot), details)


def _agreed(findings: list[Finding]) -> list[Finding]:
    """Explain wrong answers to several questions about the same scans by what fits most of them."""
    told = [i for i, finding in enumerate(findings) if finding.answers is not None]
    explanations = agreed([answers for finding in findings if (answers := finding.answers) is not None])
    for i, each in zip(told, explanations, strict=True):
        findings[i] = replace(findings[i], explanation=str(each), answers=each)
    return findings


def truth_sha256(recording: Recording, robot: str) -> str:
    """Return the SHA-256 of the true trajectory.

    The hash covers little-endian times [ns] (int64), then positions [m] and quaternions (float64).
    """
    digest = hashlib.sha256()
    for name in TRUTH:
        signal = recording.signal(f"truth/{robot}/{name}")
        digest.update(signal.times.astype("<i8").tobytes())
        digest.update(np.ascontiguousarray(signal.values, dtype="<f8").tobytes())
    return digest.hexdigest()
