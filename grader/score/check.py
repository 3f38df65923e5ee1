"""What a check is, and the registry of kinds.

A kind is a function of the recording and the parameters its manifest gives; it registers itself with `@check_kind`. It
asks for every parameter it knows, and what is left over is an author's typing mistake.
A check's `gate` is handled here for every kind: without the gate's evidence no point is given, so that doing nothing
earns nothing:

    gate = { signal = "truth/robot/distance", reaches = 0.5, otherwise = "the robot never drove" }
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

from grader.errors import ManifestError, nearest
from grader.exercise import CheckSpec
from grader.record.reading import Recording
from grader.table import Table


@dataclass(frozen=True)
class Band:
    """Where a signal is wanted: between `low` and `high` from `start` to `end` [s] of simulated time."""

    signal: str
    low: float
    high: float
    start: float
    end: float


@dataclass(frozen=True)
class Finding:
    """What one check found: what was expected, what was measured, and at which simulated moment [s].

    `gated` marks a check that failed only because its gate did: another check tells the reason.
    """

    passed: bool
    expected: str
    measured: str
    at_s: float | None = None
    bands: tuple[Band, ...] = ()
    gated: bool = False


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
    """Return every kind there is, by name."""
    from grader.score import checks

    for module in pkgutil.iter_modules(checks.__path__):
        importlib.import_module(f"{checks.__name__}.{module.name}")
    return dict(_kinds)


def perform(spec: CheckSpec, recording: Recording) -> Finding:
    """Apply one check to a recording. Raises ManifestError if the manifest's parameters do not fit the kind."""
    kinds = check_kinds()
    if spec.kind not in kinds:
        raise ManifestError(f"check {spec.id!r} is of unknown kind {spec.kind!r}{nearest(spec.kind, kinds)}")
    parameters = Table(spec.parameters, f"check {spec.id!r}", "parameter")
    gate = parameters.table("gate") if parameters.has("gate") else None
    finding = kinds[spec.kind](recording, parameters)
    parameters.end()
    if gate is not None:
        signal, reaches, otherwise = gate.text("signal"), gate.number("reaches"), gate.text("otherwise")
        gate.end()
        values = recording.signal(signal).values
        if not len(values) or values.max() < reaches:
            return replace(finding, passed=False, measured=otherwise, at_s=None, gated=True)
    return finding
