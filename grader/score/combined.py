"""The score of several trials: the worst result of each check counts, or the weighted mean of all.

A check passes only if it passes in every trial; the report shows the finding of the first trial in which it failed. If
a trial has a weight, a check that failed keeps the weighted mean of what it earned in each trial.
Used by `grader/grade.py` after every trial was scored, also for recordings scored again.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import replace

from gz_course.grader.score.consequences import CheckResult, shared
from gz_course.grader.score.score import Score

WEIGHTED = "the mean of all trials by their weights"


def combined(scores: Sequence[tuple[str, Score]], weights: Sequence[float | None] = ()) -> Score:
    """Return the score of all trials, given in order as (name, score), all for the same checks; `weights` are theirs.

    Where a check passed in one trial and failed in another, its finding names the trial. The diagnosis is that of the
    first trial that lost points, the outcome the first that is not `graded`. The hash of several trials is over their
    hashes; that of a single trial is its own.
    """
    (_, first), *others = scores
    if not others:
        return first
    weakest = [_weakest([(name, score.checks[i]) for name, score in scores]) for i in range(len(first.checks))]
    if any(weight is not None for weight in weights):
        each = [1.0 if weight is None else weight for weight in weights]
        checks = tuple(
            _mean(worst, [score.checks[i].points for _, score in scores], each) for i, worst in enumerate(weakest)
        )
    else:
        checks = _at_most(shared(weakest), min(score.points for _, score in scores))
    lost = [(name, score) for name, score in scores if score.diagnosis]
    diagnosis = lost[0][1].diagnosis if lost else ""
    if lost and len(lost) < len(scores):
        diagnosis = f"In the trial {lost[0][0]}: {diagnosis}"
    details = lost[0][1].details if lost else ""
    outcome = next((score.outcome for _, score in scores if score.outcome != "graded"), "graded")
    digest = hashlib.sha256("".join(score.truth_sha256 for _, score in scores).encode()).hexdigest()
    faults = tuple(dict.fromkeys(fault for _, score in scores for fault in score.faults))
    return Score(checks, outcome, diagnosis, digest, details, faults)


def _at_most(checks: tuple[CheckResult, ...], points: float) -> tuple[CheckResult, ...]:
    """Lower what failed checks keep, the last ones first, until they earn no more than so many points together."""
    lowered = list(checks)
    for i in reversed(range(len(lowered))):
        too_many = sum(check.points for check in lowered) - points
        lowered[i] = replace(lowered[i], kept=max(0.0, lowered[i].kept - max(0.0, too_many)))
    return tuple(lowered)


def _mean(worst: CheckResult, points: Sequence[float], weights: Sequence[float]) -> CheckResult:
    """Return the result of a check that earned these points in trials of these weights."""
    if worst.finding.passed:
        return worst
    earned = sum(each * weight for each, weight in zip(points, weights, strict=True)) / sum(weights)
    return replace(worst, finding=replace(worst.finding, credit=0.0), kept=round(earned, 2), why=WEIGHTED)


def _weakest(results: list[tuple[str, CheckResult]]) -> CheckResult:
    failed = [(name, result) for name, result in results if not result.finding.passed]
    if not failed:
        return results[0][1]
    name, worst = min(failed, key=lambda each: each[1].finding.credit)  # the first of those that earn least
    if len(failed) == len(results):
        return worst
    return replace(worst, finding=replace(worst.finding, measured=f"in the trial {name}: {worst.finding.measured}"))
