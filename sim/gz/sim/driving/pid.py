"""The PID controller used by the joint controllers.

`error` is the measured value minus the wanted one, so the command has the opposite sign. The integral term
(including its gain) stays within `i_min` and `i_max`, the command within `cmd_min` and `cmd_max`. A maximum below its
minimum disables that limit.

Source: https://github.com/gazebosim/gz-math/blob/gz-math7/src/PID.cc
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from gz_course.sim.gz.sim.sdf.element import Element

PARAMETERS = ("p_gain", "i_gain", "d_gain", "i_max", "i_min", "cmd_max", "cmd_min", "cmd_offset")


@dataclass
class PID:
    """Gains, limits and state (`integral`, `last_error`); units follow from those of the error and the command."""

    p_gain: float = 0.0
    i_gain: float = 0.0
    d_gain: float = 0.0
    i_max: float = -1.0
    i_min: float = 0.0
    cmd_max: float = -1.0
    cmd_min: float = 0.0
    cmd_offset: float = 0.0
    integral: float = field(default=0.0, init=False)
    last_error: float = field(default=0.0, init=False)

    @classmethod
    def from_sdf(cls, element: Element, *defaults: float) -> PID:
        """Read `p_gain` ... `cmd_offset`; `defaults` are in the order of `PARAMETERS`.

        Raises SdfError if a gain is not finite.
        """
        values = {tag: element.number(tag, default) for tag, default in zip(PARAMETERS, defaults, strict=True)}
        for tag in ("p_gain", "i_gain", "d_gain", "cmd_offset"):
            if not math.isfinite(values[tag]):
                raise (element.find(tag) or element).error(f"<{tag}> must be finite, got {values[tag]}")
        return cls(**values)

    def reset(self) -> None:
        self.integral = self.last_error = 0.0

    def update(self, error: float, dt: float) -> float:
        """Return the command after a step of `dt` [s] that ended with `error`; 0 if `error` or `dt` is invalid."""
        if dt == 0.0 or not math.isfinite(error):
            return 0.0
        rate = (error - self.last_error) / dt
        if not math.isfinite(rate):
            return 0.0
        self.integral += self.i_gain * dt * error
        if self.i_max >= self.i_min:
            self.integral = min(max(self.integral, self.i_min), self.i_max)
        self.last_error = error
        command = self.cmd_offset - self.p_gain * error - self.integral - self.d_gain * rate
        if self.cmd_max >= self.cmd_min:
            command = min(max(command, self.cmd_min), self.cmd_max)
        return command
