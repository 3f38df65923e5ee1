"""The score of several trials: the worst result of each check counts.

A check passes only if it passes in every trial; the report shows the finding of the first trial in which it failed.
Used by `grader/grade.py` after every trial was scored, also for recordings scored again.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import replace

from gz_course.grader.score.score import CheckResult, Score


def combined(scores: Sequence[tuple[str, Score]]) -> Score:
    """Return the score of all trials, given in order as (name, score), all for the same checks.

    Where a check passed in one trial and failed in another, its finding names the trial. The diagnosis is that of the
    first trial that lost points, the outcome the first that is not `graded`. The hash of several trials is over their
    hashes; that of a single trial is its own.
    """
    (_, first), *others = scores
    if not others:
        return first
    checks = tuple(_weakest([(name, score.checks[i]) for name, score in scores]) for i in range(len(first.checks)))
    lost = [(name, score) for name, score in scores if score.diagnosis]
    diagnosis = lost[0][1].diagnosis if lost else ""
    if lost and len(lost) < len(scores):
        diagnosis = f"In the trial {lost[0][0]}: {diagnosis}"
    details = lost[0][1].details if lost else ""
    outcome = next((score.outcome for _, score in scores if score.outcome != "graded"), "graded")
    digest = hashlib.sha256("".join(score.truth_sha256 for _, score in scores).encode()).hexdigest()
    faults = tuple(dict.fromkeys(fault for _, score in scores for fault in score.faults))
    return Score(checks, outcome, diagnosis, digest, details, faults)


def _weakest(results: list[tuple[str, CheckResult]]) -> CheckResult:
    failed = [(name, result) for name, result in results if not result.finding.passed]
    if not failed:
        return results[0][1]
    name, worst = failed[0]
    if len(failed) == len(results):
        return worst
    return replace(worst, finding=replace(worst.finding, measured=f"in the trial {name}: {worst.finding.measured}"))
