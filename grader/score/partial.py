"""Points that fall linearly with an error, for every kind of check.

    linear = { full = 0.05, none = 0.30 }   # all points at 0.05 or better, none at 0.30 or worse, between them a part

A check that passes earns all of its points, and one whose gate is closed none; this says what it earns if it fails.
The number is what the kind measures (`VALUES`), `value` of the Finding of a `python` check, or one of a signal:

    linear = { full = 0.1, none = 0.5, signal = "truth/robot/y", take = "widest" }

`take` is `last`, `largest`, `smallest`, `mean`, or `widest` (the largest distance from 0). If nothing was measured,
nothing is earned. `full` may be smaller than `none`, or larger.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording

# The number that a kind measures.
VALUES = {
    "change": "the change of the signal",
    "compare": "the share of samples that are right",
    "count": "the number of samples",
    "final_pose": "the distance from `near` [m]; without it the deviation of the heading [rad]",
    "time_in_band": "the time in the band [s]",
    "python": "`value` of the Finding",
}
TAKES: dict[str, Callable[[np.ndarray], float]] = {
    "last": lambda values: float(values[-1]),
    "largest": lambda values: float(values.max()),
    "smallest": lambda values: float(values.min()),
    "mean": lambda values: float(values.mean()),
    "widest": lambda values: float(np.abs(values).max()),
}


@dataclass(frozen=True)
class Linear:
    """All points at `full` or better, none at `none` or worse; of the number of a kind, or of a signal."""

    full: float
    none: float
    signal: str = ""
    take: str = "last"

    @staticmethod
    def read(table: Table, kind: str) -> Linear:
        """Read the table `linear` of a check of this kind. Raises ManifestError if it is wrong."""
        full, none = table.number("full"), table.number("none")
        if full == none:
            table.refuse("none", "another number than full")
        signal = table.text("signal") if table.has("signal") else ""
        take = table.choice("take", TAKES) if table.has("take") else "last"
        table.end()
        if not signal and kind not in VALUES:
            raise ManifestError(
                f'{table.where}: a check of kind {kind!r} measures no number; add signal = "..." to linear, or use one '
                f"of {', '.join(VALUES)}"
            )
        return Linear(full, none, signal, take)

    def credit(self, recording: Recording, value: float | None) -> float:
        """Return the share of the points that this number earns, from 0 to 1; `value` is what the kind measured."""
        if self.signal:
            values = recording.signal(self.signal).values
            value = TAKES[self.take](values) if len(values) else None
        if value is None or not np.isfinite(value):
            return 0.0
        return float(np.clip((self.none - value) / (self.none - self.full), 0.0, 1.0))
