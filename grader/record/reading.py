"""A reader of recordings: the only input of scoring and reports.

Works on a finished `.rrd` and on one that is still being written (after `Recorder.flush`).
"""

from __future__ import annotations

import json
import math
import warnings
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gz_course.grader.errors import UsageError
from gz_course.sim.did_you_mean import did_you_mean

STUDENT_LOG, GIVEN_LOG = "log/student", "log/given_node"  # logs of the submission and of the exercise's own node
# Of an exercise's own node beside the submission: what it has reported, as JSON, and what it has printed.
REPORTS, PRINTED = "exercise_node/reports", "exercise_node/printed"


@dataclass(frozen=True)
class Signal:
    """Samples of one number, sorted by time: `times` of simulated time [ns] (n,) and `values` (n,)."""

    times: np.ndarray
    values: np.ndarray

    def __len__(self) -> int:
        return len(self.times)


@dataclass(frozen=True)
class Poses:
    """The poses of an entity relative to its parent, sorted by time.

    `times` of simulated time [ns] (n,), `positions` [m] (n, 3), `quaternions` x, y, z, w (n, 4). What never moves has
    one row, at time 0.
    """

    times: np.ndarray
    positions: np.ndarray
    quaternions: np.ndarray


@dataclass(frozen=True)
class Line:
    """One line of a log."""

    time_ns: int
    text: str
    level: str


def flattened(column: Any) -> Any:
    """Return the values of an Arrow column of lists, one after another.

    `flatten` does the same, but imports all of Arrow's functions, which takes longer than reading a recording.
    """
    if column.null_count:
        return column.flatten()
    if (size := getattr(column.type, "list_size", None)) is not None:
        return column.values.slice(column.offset * size, len(column) * size)
    first, last = column.offsets[0].as_py(), column.offsets[-1].as_py()
    return column.values.slice(first, last - first)


class Recording:
    """One recorded run. Raises UsageError if the file is not a readable recording."""

    def __init__(self, path: Path) -> None:
        from rerun.chunk import RrdReader

        if not path.is_file():
            raise UsageError(f"no recording at {path}: give the .rrd file that `course grade` wrote")
        self.path = path
        self._rows: dict[tuple[str, str], list[tuple[np.ndarray, Any]]] = {}  # times, Arrow column
        self._static: dict[str, dict[str, Any]] = defaultdict(dict)  # Arrow columns of one row
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # a file that is still being written has no footer
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
            self._static[chunk.entity_path.lstrip("/")].update({name: batch.column(name) for name in components})
            return
        if "sim_time" not in names:
            return
        times = batch.column("sim_time").to_numpy(zero_copy_only=False).astype(np.int64)
        for name in components:
            key = (chunk.entity_path.lstrip("/"), name)
            self._rows.setdefault(key, []).append((times, batch.column(name)))

    def _column(self, entity: str, component: str) -> tuple[np.ndarray, list[np.ndarray]]:
        """Return all rows of a component sorted by time: times [ns] and one numpy array per row."""
        parts = self._rows.get((entity, component), [])
        if not parts:
            return np.empty(0, dtype=np.int64), []
        times = np.concatenate([t for t, _ in parts])
        rows = [np.asarray(row.values) for _, column in parts for row in column]
        order = np.argsort(times, kind="stable")
        return times[order], [rows[i] for i in order]

    def signals(self) -> list[str]:
        """Return the names of all signals (single numbers over time)."""
        return sorted(
            entity
            for (entity, component), parts in self._rows.items()
            if component == "Scalars:scalars" and all(len(flattened(column)) == len(times) for times, column in parts)
        )

    def has(self, name: str) -> bool:
        return (name, "Scalars:scalars") in self._rows

    def signal(self, name: str) -> Signal:
        """Return a signal by its name, such as `truth/robot/x`; empty if it was not recorded."""
        parts = self._rows.get((name, "Scalars:scalars"), [])
        if not parts:
            return Signal(np.empty(0, dtype=np.int64), np.empty(0))
        times = np.concatenate([t for t, _ in parts])
        values = np.concatenate([flattened(column).to_numpy(zero_copy_only=False) for _, column in parts])
        if len(values) != len(times):
            raise UsageError(f"{name} holds lists, not single numbers{did_you_mean(name, self.signals())}")
        order = np.argsort(times, kind="stable")
        return Signal(times[order], values[order])

    def arrays(self, name: str) -> tuple[np.ndarray, list[np.ndarray]]:
        """Return a signal whose samples are lists of numbers: times [ns] and one array per sample."""
        return self._column(name, "Scalars:scalars")

    @property
    def node_log(self) -> str:
        """Entity of the log of the program that was run: the exercise's own node if any, else the student's."""
        return GIVEN_LOG if (GIVEN_LOG, "TextLog:text") in self._rows else STUDENT_LOG

    def lines(self, entity: str) -> list[Line]:
        """Return the lines of a log such as `log/student`, in order."""
        out: list[tuple[int, str, str]] = []
        texts = self._rows.get((entity, "TextLog:text"), [])
        levels = self._rows.get((entity, "TextLog:level"), [])
        for (times, text), (_, level) in zip(texts, levels, strict=True):
            out += zip(
                times.tolist(),
                flattened(text).to_pylist(),
                flattened(level).to_pylist(),
                strict=True,
            )
        out.sort(key=lambda row: row[0])
        return [Line(*row) for row in out]

    def properties(self, name: str) -> dict[str, Any]:
        """Return the facts stored under a name, or an empty dict."""
        return self.static(f"__properties/{name}")

    @property
    def parameters(self) -> dict[str, Any]:
        """The parameters of the trial, by name."""
        return dict(self._of_trial("trial_parameters").get("parameters", {}))

    @property
    def private(self) -> dict[str, Any]:
        """The private data of the trial, by name; no submission has them."""
        return self._of_trial("trial_private")

    def _of_trial(self, key: str) -> dict[str, Any]:
        found = json.loads(self.properties("run").get(key) or "{}")
        return found if isinstance(found, dict) else {}

    def static(self, entity: str) -> dict[str, Any]:
        """Return the static components of an entity such as `world/robot/base_link/chassis`, by name."""
        values = {name: column[0].as_py() for name, column in self._static.get(entity, {}).items()}
        return {name: value[0] if value and len(value) == 1 else value for name, value in values.items()}

    def entities(self, below: str, component: str = "") -> list[str]:
        """Return the entities below one, such as `world`, with a component whose name begins with `component`."""
        held = [*self._rows, *((entity, name) for entity, names in self._static.items() for name in names)]
        return sorted({e for e, name in held if e.startswith(f"{below}/") and name.startswith(component)})

    def poses(self, entity: str) -> Poses | None:
        """Return the poses of an entity relative to its parent; None if it has no pose of its own."""
        parts = []
        for component, width in (("Transform3D:translation", 3), ("Transform3D:quaternion", 4)):
            rows = self._rows.get((entity, component), [])
            if not rows and component in self._static.get(entity, {}):
                rows = [(np.zeros(1, dtype=np.int64), self._static[entity][component])]
            if not rows:
                return None
            values = [flattened(flattened(column)).to_numpy(zero_copy_only=False) for _, column in rows]
            parts.append((np.concatenate([t for t, _ in rows]), np.concatenate(values).reshape(-1, width)))
        (times, positions), (_, quaternions) = parts
        order = np.argsort(times, kind="stable")
        return Poses(times[order], positions[order], quaternions[order])

    def points_at(self, entity: str, time_ns: int) -> np.ndarray:
        """Return the last point cloud (n, 3) [m] of an entity at a time [ns]; empty before the first."""
        row = self._last_row(entity, "Points3D:positions", time_ns)
        return np.empty((0, 3)) if row is None else np.asarray(flattened(row.values)).reshape(-1, 3)

    def picture_at(self, entity: str, time_ns: int) -> bytes:
        """Return the last encoded image of an entity at a time [ns]; empty before the first."""
        row = self._last_row(entity, "EncodedImage:blob", time_ns)
        return b"" if row is None else bytes(np.asarray(flattened(row.values), dtype=np.uint8))

    def pictures(self, entity: str) -> tuple[np.ndarray, list[bytes]]:
        """Return the encoded images of an entity: times [ns] and one file each."""
        times, rows = self._column(entity, "EncodedImage:blob")
        return times, [bytes(np.concatenate(row).astype(np.uint8)) for row in rows]

    def _last_row(self, entity: str, component: str, time_ns: int) -> Any:
        """Return the Arrow list of the last row at or before a time [ns], or None."""
        found, when = None, -1
        for times, column in self._rows.get((entity, component), []):
            index = int(np.searchsorted(times, time_ns, side="right")) - 1
            if index >= 0 and times[index] >= when:
                found, when = column[index], int(times[index])
        return found

    def facts(self) -> dict[str, Any]:
        """Return what the run recorded about the submission: endpoints, exit, dropped messages."""
        text = self.properties("run").get("facts")
        return json.loads(text) if text else {}

    @property
    def ended_s(self) -> float:
        """End of simulated time [s]; before the exercise's end if the simulation was aborted."""
        return float(self.facts().get("sim_seconds", math.inf))

    @property
    def end_ns(self) -> int:
        """Last recorded instant of simulated time [ns]."""
        return max((int(times[-1]) for parts in self._rows.values() for times, _ in parts), default=0)
