"""Signals as step functions: a sample holds until the next one, as a velocity command does."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from grader.record.reading import Recording


@dataclass(frozen=True)
class Condition:
    """A signal is to lie between `low` and `high` (both included); `name` and `unit` are what people read."""

    signal: str
    low: float
    high: float
    name: str
    unit: str

    @staticmethod
    def read(raw: dict[str, Any]) -> Condition:
        """Read a condition from a manifest; a missing bound is no bound."""
        low, high = float(raw.get("low", -np.inf)), float(raw.get("high", np.inf))
        unit = f" {raw['unit']}" if "unit" in raw else ""
        return Condition(raw["signal"], low, high, raw.get("name", raw["signal"]), unit)

    def __str__(self) -> str:
        """The condition in words."""
        if np.isinf(self.high):
            return f"{self.name} at least {self.low:g}{self.unit}"
        if np.isinf(self.low):
            return f"{self.name} at most {self.high:g}{self.unit}"
        return f"{self.name} between {self.low:g} and {self.high:g}{self.unit}"


def fulfilled(
    recording: Recording, conditions: list[Condition], start: float, end: float
) -> tuple[np.ndarray, np.ndarray]:
    """When do all conditions hold at once between `start` and `end` [s]?

    Returns the edges [s], shape (n + 1,), of n intervals and whether the conditions hold in each, shape (n,). Before
    its first sample a signal fulfils nothing.
    """
    signals = [recording.signal(c.signal) for c in conditions]
    times = np.concatenate([s.times / 1e9 for s in signals]) if signals else np.empty(0)
    inner = np.unique(times[(times > start) & (times < end)])
    edges = np.concatenate([[start], inner, [end]])
    holds = np.ones(len(edges) - 1, dtype=bool)
    for condition, signal in zip(conditions, signals, strict=True):
        index = np.searchsorted(signal.times / 1e9, edges[:-1], side="right") - 1
        values = (
            np.where(index >= 0, signal.values[np.maximum(index, 0)], np.nan)
            if len(signal)
            else np.full(len(index), np.nan)
        )
        with np.errstate(invalid="ignore"):
            holds &= (values >= condition.low) & (values <= condition.high)
    return edges, holds


def value_at(recording: Recording, name: str, time: float) -> float | None:
    """Value of a signal at a time [s]: that of the last sample before it; None before the first."""
    signal = recording.signal(name)
    index = int(np.searchsorted(signal.times, round(time * 1e9), side="right")) - 1
    return float(signal.values[index]) if index >= 0 else None
