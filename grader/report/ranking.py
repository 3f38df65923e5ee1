"""The numbers of a submission by which its class is ranked, as the manifest's `[[leaderboard]]` says."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gz_course.grader.exercise.leaderboard import Ranked

if TYPE_CHECKING:
    from gz_course.grader.score.score import Score


@dataclass(frozen=True)
class Place:
    """A number that counts: what it is called, and whether the lowest or the highest is best."""

    name: str
    value: float
    best: str


def places(leaderboard: Sequence[Ranked], scores: Sequence[Score]) -> tuple[Place, ...]:
    """Return the numbers of a submission; one whose check fails in a trial, or measures nothing, has none.

    `scores` are those of its trials.
    """
    found = []
    for ranked in leaderboard:
        findings = [check.finding for score in scores for check in score.checks if check.spec.id == ranked.check]
        values = [each.value for each in findings if each.value is not None and math.isfinite(each.value)]
        if findings and all(each.passed for each in findings) and len(values) == len(findings):
            found.append(Place(ranked.name, round(float(ranked.worst(values)), 6), ranked.best))
    return tuple(found)
