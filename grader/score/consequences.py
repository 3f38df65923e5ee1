"""What one misconception costs: together, all checks that it fails lose at most 40 % of the points of the exercise.

Which checks have one cause is declared, and never taken from what the feedback says: a check that fails shares the cost
with the failed checks from which it is declared to follow, by `consequence_of` in the manifest or by a gate on them,
and with all that follow from the same one. Each then loses its part of the 40 %, in whole points, and keeps the rest.
A check that fails alone loses all of its points. So does one that follows only from checks that had nothing to look
at, for these are no cause. A submission that passes no check at all earns nothing.

    [[check]]
    id = "stops"
    consequence_of = ["finds_the_posts"]    # who looks in the wrong place cannot stop at the right one
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from gz_course.grader.exercise import CheckSpec
from gz_course.grader.score.check import Finding

MOST_FOR_ONE = 0.4  # of all points


@dataclass(frozen=True)
class CheckResult:
    """One line of the report. `kept` are the points that a failed check keeps because others have the same cause.

    `why` says another reason for them. A check whose points fall with an error earns its credit at least.
    """

    spec: CheckSpec
    finding: Finding
    kept: float = 0.0
    why: str = ""

    @property
    def points(self) -> float:
        if self.finding.passed:
            return self.spec.points
        return max(self.kept, round(self.finding.credit * self.spec.points, 2))


def shared(checks: Sequence[CheckResult]) -> tuple[CheckResult, ...]:
    """Return the results with what their failed checks keep, because they have one cause."""
    failed = {check.spec.id: check for check in checks if not check.finding.passed}
    if len(failed) == len(checks):
        return tuple(replace(check, kept=0.0) for check in checks)
    groups: dict[str, list[CheckResult]] = {}
    for id, check in failed.items():
        if cause := _cause(id, failed):
            groups.setdefault(cause, []).append(check)
    most = MOST_FOR_ONE * sum(check.spec.points for check in checks)
    kept: dict[str, float] = {}
    for group in (each for each in groups.values() if len(each) > 1):
        parts = _parts([check.spec.points for check in group], most)
        kept |= {check.spec.id: check.spec.points - lost for check, lost in zip(group, parts, strict=True)}
    return tuple(replace(check, kept=float(kept.get(check.spec.id, 0))) for check in checks)


def links(spec: CheckSpec) -> Iterator[str]:
    """Yield the ids of the checks from which a failure of this one may follow."""
    yield from spec.consequence_of
    gates = spec.parameters.get("gate", [])
    yield from (gate["check"] for gate in (gates if isinstance(gates, list) else [gates]) if "check" in gate)


def _cause(id: str, failed: Mapping[str, CheckResult]) -> str:
    """Return the failed check that this one follows from and that follows from no other one; or nothing."""
    causes = [each for each in _reached(id, failed) if not _had_nothing(failed[each].finding)]
    first = [each for each in causes if not set(_reached(each, failed)) & (set(causes) - {each})]
    order = list(failed)
    return min(first or causes, key=order.index, default="")


def _reached(id: str, failed: Mapping[str, CheckResult]) -> list[str]:
    """Return a failed check and all failed ones from which its failure may follow, directly or by others."""
    found = [id]
    for each in found:
        found += [other for other in links(failed[each].spec) if other in failed and other not in found]
    return found


def _had_nothing(finding: Finding) -> bool:
    return finding.gated or finding.nothing


def _parts(points: Sequence[float], most: float) -> list[float]:
    """Return what each check of a group loses: all, or its part of `most` in whole points."""
    total = sum(points)
    if total <= most:
        return list(points)
    exact = [each * most / total for each in points]
    parts = [float(int(each)) for each in exact]
    by_rest = sorted(range(len(parts)), key=lambda i: parts[i] - exact[i])
    for i in by_rest[: round(most - sum(parts))]:
        parts[i] += 1
    return parts
