"""Limits of a commanded speed: velocity, acceleration and jerk.

Used by drive systems once per step and per degree of freedom: jerk is limited first, then acceleration, then
velocity.

Source: https://github.com/gazebosim/gz-math/blob/gz-math7/src/SpeedLimiter.cc
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from gz_course.sim.gz.sim.sdf.element import Element

_BOUNDS, _QUANTITIES = ("min", "max"), ("velocity", "acceleration", "jerk")


def limit_parameters(*axes: str) -> list[str]:
    """Return the parameters that set limits: `min_velocity` ... `max_jerk`, and those of each axis."""
    prefixes = ("", *(f"{axis}_" for axis in axes))
    return [f"{bound}_{prefix}{quantity}" for bound in _BOUNDS for prefix in prefixes for quantity in _QUANTITIES]


@dataclass
class SpeedLimiter:
    """Limits of velocity [m/s, rad/s], acceleration [m/s^2, rad/s^2] and jerk [m/s^3, rad/s^3]; minima are usually
    negative.
    """

    min_velocity: float = -math.inf
    max_velocity: float = math.inf
    min_acceleration: float = -math.inf
    max_acceleration: float = math.inf
    min_jerk: float = -math.inf
    max_jerk: float = math.inf

    @classmethod
    def from_sdf(cls, element: Element, axis: str) -> SpeedLimiter:
        """Read `min_velocity` ... `max_jerk`; names with `axis`, as `min_linear_velocity`, take precedence."""
        limiter = cls()
        for bound in _BOUNDS:
            for quantity in _QUANTITIES:
                value = element.number(f"{bound}_{quantity}", getattr(limiter, f"{bound}_{quantity}"))
                value = element.number(f"{bound}_{axis}_{quantity}", value)
                setattr(limiter, f"{bound}_{quantity}", value)
        for quantity in _QUANTITIES:
            lower, upper = getattr(limiter, f"min_{quantity}"), getattr(limiter, f"max_{quantity}")
            if lower > upper:
                raise element.error(f"min {axis} {quantity} ({lower}) is above max {axis} {quantity} ({upper})")
        return limiter

    @property
    def unlimited(self) -> bool:
        """True if no limit is set, so that `limit` returns its input."""
        return self == SpeedLimiter()

    def limit(self, target: float, previous: float, before_previous: float, dt: float) -> float:
        """Return the speed to command now; `previous` and `before_previous` are the last two commands, `dt` is the step
        [s].
        """
        last_acceleration = (previous - before_previous) / dt
        jerk = ((target - previous) / dt - last_acceleration) / dt
        limited_jerk = min(max(jerk, self.min_jerk), self.max_jerk)
        if limited_jerk != jerk:
            target = previous + (last_acceleration + limited_jerk * dt) * dt
        acceleration = (target - previous) / dt
        limited = min(max(acceleration, self.min_acceleration), self.max_acceleration)
        if limited != acceleration:
            target = previous + limited * dt
        return min(max(target, self.min_velocity), self.max_velocity)
