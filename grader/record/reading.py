"""Reads a recording back: the only thing that scoring and reports ever look at.

Works on a finished `.rrd` and on one that is still being written (after `Recorder.flush`).
"""

from __future__ import annotations

import json
import math
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from grader.errors import UsageError, nearest


@dataclass(frozen=True)
class Signal:
    """Samples of one number: `times` in simulated nanoseconds (n,), `values` (n,), both sorted by time."""

    times: np.ndarray
    values: np.ndarray

    def __len__(self) -> int:
        return len(self.times)


@dataclass(frozen=True)
class Line:
    """One line of a log."""

    time_ns: int
    text: str
    level: str


class Recording:
    """One run, as recorded. Raises UsageError if the file is not a readable recording."""

    def __init__(self, path: Path) -> None:
        from rerun.chunk import RrdReader

        if not path.is_file():
            raise UsageError(f"no recording at {path}: give the .rrd file that `course grade` wrote")
        self.path = path
        self._rows: dict[tuple[str, str], list[tuple[np.ndarray, Any]]] = {}  # times, arrow column
        self._static: dict[str, dict[str, Any]] = {}
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # a file still being written has no footer yet
                chunks = list(RrdReader(path).stream())
        except Exception as error:
            raise UsageError(f"{path} is not a readable recording: {str(error).splitlines()[0]}") from None
        for chunk in chunks:
            self._add(chunk)

    def _add(self, chunk: Any) -> None:
        batch = chunk.to_record_batch()
        names = batch.schema.names
        components = [name for name in names if name not in ("rerun.controls.RowId", "sim_time", "log_time")]
        if chunk.is_static:
            entity = self._static.setdefault(chunk.entity_path.lstrip("/"), {})
            for name in components:
                value = batch.column(name)[0].as_py()
                entity[name] = value[0] if value and len(value) == 1 else value
            return
        if "sim_time" not in names:
            return
        times = batch.column("sim_time").cast("int64").to_numpy(zero_copy_only=False)
        for name in components:
            key = (chunk.entity_path.lstrip("/"), name)
            self._rows.setdefault(key, []).append((times, batch.column(name)))

    def _column(self, entity: str, component: str) -> tuple[np.ndarray, list[np.ndarray]]:
        """All rows of a component sorted by time: times [ns] and one numpy array per row."""
        parts = self._rows.get((entity, component), [])
        if not parts:
            return np.empty(0, dtype=np.int64), []
        times = np.concatenate([t for t, _ in parts])
        rows = [np.asarray(row.values) for _, column in parts for row in column]
        order = np.argsort(times, kind="stable")
        return times[order], [rows[i] for i in order]

    def signals(self) -> list[str]:
        """Names of all signals (single numbers over time)."""
        return sorted(
            entity
            for (entity, component), parts in self._rows.items()
            if component == "Scalars:scalars" and all(len(column.flatten()) == len(times) for times, column in parts)
        )

    def has(self, name: str) -> bool:
        """Whether the signal was recorded at all."""
        return (name, "Scalars:scalars") in self._rows

    def signal(self, name: str) -> Signal:
        """Return a signal by its name, such as `truth/robot/x`; empty if nothing was recorded under it."""
        parts = self._rows.get((name, "Scalars:scalars"), [])
        if not parts:
            return Signal(np.empty(0, dtype=np.int64), np.empty(0))
        times = np.concatenate([t for t, _ in parts])
        values = np.concatenate([column.flatten().to_numpy(zero_copy_only=False) for _, column in parts])
        if len(values) != len(times):
            raise UsageError(f"{name} holds lists, not single numbers{nearest(name, self.signals())}")
        order = np.argsort(times, kind="stable")
        return Signal(times[order], values[order])

    def arrays(self, name: str) -> tuple[np.ndarray, list[np.ndarray]]:
        """Return a signal whose samples are lists of numbers: times [ns] and one array per sample."""
        return self._column(name, "Scalars:scalars")

    def lines(self, entity: str) -> list[Line]:
        """Return the lines of a log such as `log/student`, in order."""
        out: list[tuple[int, str, str]] = []
        texts = self._rows.get((entity, "TextLog:text"), [])
        levels = self._rows.get((entity, "TextLog:level"), [])
        for (times, text), (_, level) in zip(texts, levels, strict=True):
            out += zip(
                times.tolist(),
                text.flatten().to_pylist(),
                level.flatten().to_pylist(),
                strict=True,
            )
        out.sort(key=lambda row: row[0])
        return [Line(*row) for row in out]

    def properties(self, name: str) -> dict[str, Any]:
        """Return the facts stored under a name, or an empty dict."""
        return dict(self._static.get(f"__properties/{name}", {}))

    def facts(self) -> dict[str, Any]:
        """Return what the run reported about the submission: endpoints, exit, dropped messages."""
        text = self.properties("run").get("facts")
        return json.loads(text) if text else {}

    @property
    def ended_s(self) -> float:
        """When simulated time ended [s], which is before the exercise's end if the simulation broke off."""
        return float(self.facts().get("sim_seconds", math.inf))

    @property
    def end_ns(self) -> int:
        """The last simulated instant on record [ns]."""
        return max((int(times[-1]) for parts in self._rows.values() for times, _ in parts), default=0)
