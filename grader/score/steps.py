"""Signals as step functions: a sample holds until the next one, as a velocity command does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording


@dataclass(frozen=True)
class Condition:
    """A signal should be between `low` and `high` (both included); `name` and `unit` are shown to people."""

    signal: str
    low: float
    high: float
    name: str
    unit: str

    @staticmethod
    def read_all(parameters: Table) -> list[Condition]:
        """Read the `conditions` of a check; a missing bound is infinite."""
        return [Condition.read(table) for table in parameters.tables("conditions")]

    @staticmethod
    def read(table: Table) -> Condition:
        signal = table.text("signal")
        condition = Condition(
            signal,
            table.number("low", -np.inf, infinite=True),
            table.number("high", np.inf, infinite=True),
            table.text("name", signal),
            f" {table.text('unit')}" if table.has("unit") else "",
        )
        table.end()
        return condition

    def __str__(self) -> str:
        """Return the condition in words."""
        if np.isinf(self.high):
            return f"{self.name} at least {self.low:g}{self.unit}"
        if np.isinf(self.low):
            return f"{self.name} at most {self.high:g}{self.unit}"
        return f"{self.name} between {self.low:g} and {self.high:g}{self.unit}"


def fulfilled(
    recording: Recording, conditions: list[Condition], start: float, end: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return when, between `start` and `end` [s], all conditions hold at once.

    The result is the edges [s], shape (n + 1,), of n intervals and whether the conditions hold in each, shape (n,).
    Before its first sample and after the end of the simulation a signal fulfils no condition.
    """
    signals = [recording.signal(c.signal) for c in conditions]
    times = np.concatenate([s.times / 1e9 for s in signals]) if signals else np.empty(0)
    times = np.append(times, recording.ended_s)
    inner = np.unique(times[(times > start) & (times < end)])
    edges = np.concatenate([[start], inner, [end]])
    holds = edges[:-1] < recording.ended_s
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


def window_of(recording: Recording, parameters: Table) -> tuple[float, float]:
    """Read the `window` of a check [s]; the whole run if it is left out."""
    start, end = parameters.numbers("window", [2], [0.0, recording.properties("run")["duration"]])
    if not start < end:
        parameters.refuse("window", "two times, the earlier one first")
    return start, end


def how_many(least: float, most: float) -> str:
    """Return a wanted number in words: `exactly 2`, `at least 1`, `at most 0`, `2 to 4`."""
    if least == most:
        return f"exactly {least:g}"
    if np.isinf(most):
        return f"at least {least:g}"
    return f"{least:g} to {most:g}" if least > 0 else f"at most {most:g}"


def value_at(recording: Recording, name: str, time: float) -> float | None:
    """Return a signal's value at a time [s]: that of the last sample before it; None before the first."""
    signal = recording.signal(name)
    index = int(np.searchsorted(signal.times, round(time * 1e9), side="right")) - 1
    return float(signal.values[index]) if index >= 0 else None


def shown_at(recording: Recording, conditions: list[Condition], at: float) -> str:
    """Return in words the values of the conditions' signals at a time [s]."""

    def one(condition: Condition) -> str:
        if at >= recording.ended_s:
            return f"the simulation ended at {recording.ended_s:.2f} s"
        value = value_at(recording, condition.signal, at)
        return (
            f"{condition.name} was {told(value)}{condition.unit}"
            if value is not None
            else f"{condition.name} had no value"
        )

    return f"{', '.join(dict.fromkeys(map(one, conditions)))} at {at:.2f} s"


def told(value: float) -> str:
    """Return a number with two decimals, or fewer digits if it is huge."""
    return f"{round(value, 2) + 0.0:.2f}" if abs(value) < 1e9 else f"{value:.3g}"  # + 0.0 avoids "-0.00"
