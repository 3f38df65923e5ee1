"""`stays_in_band`: did signals lie in their bands without a break to the end of the run?

    kind = "stays_in_band"
    conditions = [{ signal = "truth/robot/linear_x", low = -0.02, high = 0.02 }]
    last = 1.5                # [s] before the end of the run
    unit = "m/s"
"""

from __future__ import annotations

from typing import Any

import numpy as np

from grader.record.reading import Recording
from grader.score.check import Band, Finding, check_kind
from grader.score.steps import Condition, fulfilled, value_at


@check_kind("stays_in_band")
def stays_in_band(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if every condition holds at every moment of the last `last` seconds."""
    conditions = [Condition.read(c) for c in parameters["conditions"]]
    unit = f" {parameters['unit']}" if "unit" in parameters else ""
    end = recording.properties("run")["duration"]
    start = end - parameters["last"]
    edges, holds = fulfilled(recording, conditions, start, end)
    wanted = " and ".join(f"{c.signal} between {c.low:g} and {c.high:g}{unit}" for c in conditions)
    expected = f"{wanted} from {start:g} s to the end at {end:g} s"
    bands = tuple(Band(c.signal, c.low, c.high, start, end) for c in conditions)
    if holds.all():
        return Finding(True, expected, "so it did", end, bands)
    at = float(edges[:-1][~holds][0])
    values = [(c.signal, value_at(recording, c.signal, at)) for c in conditions]
    shown = ", ".join(f"{name} was {value:.2f}" if value is not None else f"{name} had no value" for name, value in values)
    return Finding(False, expected, f"{shown}{unit} at {at:.2f} s", float(np.round(at, 3)), bands)
