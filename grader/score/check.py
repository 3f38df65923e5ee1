"""What a check is, and the registry of kinds.

A kind is a function of the recording and the check's parameters in the manifest; it registers itself with
`@check_kind`. It reads every parameter it knows; a parameter left over is an author's typing mistake. A check's `gate`
is handled here for every kind: points are given only if the gate is passed, so that doing nothing earns nothing and
quality counts only after success. `gate` is one gate or a list:

    gate = { signal = "truth/robot/distance", reaches = 0.5, otherwise = "the robot never drove" }
    gate = { signal = "truth/robot/x", falls_to = -1.0, otherwise = "the robot never drove back" }
    gate = { check = "arrives", otherwise = "the robot never arrived" }      # another check must pass

Points of any check may fall with an error, as `partial.py` says: `linear = { full = 0.05, none = 0.3 }`.

Any check may ask why velocity commands are wrong; `explanations/commands.py` tries what programs with a common
misconception send. The speed [m/s] and the time [s] are those that the exercise asks for:

    explain = { commands = "topics/cmd_vel", linear_x = 0.5, seconds = 5.0 }
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import CheckSpec
from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.feedback.predictions.answers import Explanation
from gz_course.grader.feedback.predictions.commands import WantedDrive
from gz_course.grader.record.reading import Recording
from gz_course.grader.registry import modules
from gz_course.grader.score.partial import Linear
from gz_course.sim.did_you_mean import did_you_mean


@dataclass(frozen=True)
class Band:
    """The band a signal should be in: between `low` and `high` from `start` to `end` [s] of simulated time."""

    signal: str
    low: float
    high: float
    start: float
    end: float


@dataclass(frozen=True)
class Finding:
    """The result of one check: what was expected, what was measured, and at which simulated time [s].

    `gated` marks a check that failed only because its gate did: another check gives the reason. `timing` marks a check
    that, if it failed, saw the right thing at the wrong time or for the wrong time: perhaps a node reads another clock.
    `explanation` names the misconception that fits what was seen; empty if none does. `answers` is the same with all
    that fit, where others about the same scans may tell which of them is meant. `nothing` marks a check that had
    nothing to look at: it is no cause for which other checks fail (`consequences.py`). `value` is
    the number that was measured, in the unit of the check, `credit` the share of the points that a failed check earns.
    """

    passed: bool
    expected: str
    measured: str
    at_s: float | None = None
    bands: tuple[Band, ...] = ()
    gated: bool = False
    timing: bool = False
    explanation: str = ""
    answers: Explanation | None = None
    nothing: bool = False
    value: float | None = None
    credit: float = 0.0


Kind = Callable[[Recording, Table], Finding]
_kinds: dict[str, Kind] = {}


def check_kind(name: str) -> Callable[[Kind], Kind]:
    """Register a function as the kind of check called `name`."""

    def register(function: Kind) -> Kind:
        if name in _kinds:
            raise ValueError(f"the check kind {name!r} is registered twice")
        _kinds[name] = function
        return function

    return register


@cache
def check_kinds() -> dict[str, Kind]:
    """Return every kind of check, by name."""
    from gz_course.grader.score import checks

    modules(checks)
    return dict(_kinds)


def perform_all(
    specs: Sequence[CheckSpec],
    recording: Recording,
    folder: Path | None = None,
    performing: Callable[..., Finding] | None = None,
) -> list[Finding]:
    """Apply all checks of an exercise, whose manifest lies in `folder`, to a recording, by `perform`.

    Raises ManifestError if the manifest's parameters do not fit the kinds, or if gates depend on each other in a cycle.
    """
    known = {spec.id: spec for spec in specs}
    found: dict[str, Finding] = {}
    waiting: list[str] = []

    def finding_of(id: str) -> Finding:
        if id in found:
            return found[id]
        if id in waiting:
            raise ManifestError(
                f"the gates of the checks {', '.join(waiting[waiting.index(id) :])} wait for each other"
            )
        if id not in known:
            hint = did_you_mean(id, known, listing="known")
            raise ManifestError(f"check {waiting[-1]!r}: its gate names no check: {id!r}{hint}")
        waiting.append(id)
        found[id] = (performing or perform)(known[id], recording, folder, finding_of)
        waiting.pop()
        return found[id]

    return [finding_of(spec.id) for spec in specs]


def perform(
    spec: CheckSpec,
    recording: Recording,
    folder: Path | None = None,
    finding_of: Callable[[str], Finding] | None = None,
    kind: Kind | None = None,
) -> Finding:
    """Apply one check to a recording; `finding_of` returns the finding of another check, for gates.

    `kind` stands in for the kind that the check names.

    Raises ManifestError if the manifest's parameters do not fit the kind.
    """
    kinds = check_kinds()
    if spec.kind not in kinds:
        hint = did_you_mean(spec.kind, kinds, listing="known")
        raise ManifestError(f"check {spec.id!r} is of unknown kind {spec.kind!r}{hint}")
    parameters = Table(spec.parameters, f"check {spec.id!r}", "parameter", folder)
    gates: list[Table] = []
    if parameters.has("gate"):
        several = isinstance(spec.parameters["gate"], list)
        gates = parameters.tables("gate") if several else [parameters.table("gate")]
    wanted = WantedDrive.read(parameters.table("explain")) if parameters.has("explain") else None
    linear = Linear.read(parameters.table("linear"), spec.kind) if parameters.has("linear") else None
    finding = (kind or kinds[spec.kind])(recording, parameters)
    parameters.end()
    if linear and not finding.passed:
        finding = replace(finding, credit=linear.credit(recording, finding.value))
    if wanted and not finding.passed:
        finding = replace(finding, explanation=wanted.explain(recording))
    closed = [sentence for gate in gates if (sentence := _closed(gate, recording, finding_of))]
    if closed:
        return replace(finding, passed=False, measured=closed[0], at_s=None, gated=True, credit=0.0)
    return finding


def _closed(gate: Table, recording: Recording, finding_of: Callable[[str], Finding] | None) -> str:
    """Return why a gate is closed; empty if it is open."""
    if gate.has("check"):
        other, otherwise = gate.text("check"), gate.text("otherwise")
        gate.end()
        return "" if finding_of is None or finding_of(other).passed else otherwise
    signal = gate.text("signal")
    values = recording.signal(signal).values
    if gate.has("falls_to"):
        limit = gate.number("falls_to")
        evidence = bool(len(values) and values.min() <= limit)
    else:
        limit = gate.number("reaches")
        evidence = bool(len(values) and values.max() >= limit)
    otherwise = gate.text("otherwise")
    gate.end()
    return "" if evidence else otherwise
