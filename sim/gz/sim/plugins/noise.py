"""Gaussian sensor noise as SDF describes it: mean, standard deviation, a bias drawn once a run, a bias that
wanders, precision.

A sensor reads its `<noise>` with `Noise.from_sdf`. Sensors of a few numbers (an IMU has six) keep them in
`Channels`, one noise each; scans and images apply one `Noise` to all their values.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/GaussianNoiseModel.cc
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.sensor import SensorBase

KINDS = ("none", "gaussian", "gaussian_quantized")
COARSEST_IGNORED = 1e-6
"""Gazebo takes a precision up to this for none."""


@dataclass(frozen=True)
class Noise:
    """`mean` and the deviations are in the unit of the measured quantity; `precision` > 0 rounds to its
    multiples. `dynamic_bias_stddev` is a density (unit/sqrt(s)), `dynamic_bias_correlation_time` in s.
    """

    mean: float = 0.0
    stddev: float = 0.0
    bias_mean: float = 0.0
    bias_stddev: float = 0.0
    precision: float = 0.0
    dynamic_bias_stddev: float = 0.0
    dynamic_bias_correlation_time: float = 0.0

    @classmethod
    def from_sdf(cls, element: Element | None) -> Noise:
        """Read a `<noise>` element (None, or type none: no noise); raise `SdfError` for an unknown type and for
        deviations, a precision or a time that are negative or not finite.
        """
        if element is None:
            return cls()
        kind = element.text_of("type") or element.attributes.get("type", "none")
        if kind == "none":
            return cls()
        if kind not in KINDS:
            raise element.error(f"noise type '{kind}' is not known{did_you_mean(kind, KINDS, listing='types are')}")
        values = {tag: element.number(tag, 0.0) for tag in cls.__dataclass_fields__}
        for tag, value in values.items():
            if not math.isfinite(value) or (value < 0.0 and tag not in ("mean", "bias_mean")):
                limit = "finite" if tag in ("mean", "bias_mean") else "finite and not negative"
                raise (element.find(tag) or element).error(f"<{tag}> of <noise> must be {limit}, got {value}")
        return cls(**values)

    @property
    def silent(self) -> bool:
        """True when applying it changes nothing."""
        return self == Noise()

    @property
    def wanders(self) -> bool:
        """True when its bias changes with time."""
        return self.dynamic_bias_stddev > 0.0 and self.dynamic_bias_correlation_time > 0.0

    def draw_bias(self, random: np.random.Generator) -> float:
        """Return the bias at the start of a run; its sign is random."""
        if self.bias_mean == 0.0 and self.bias_stddev == 0.0:
            return 0.0
        bias = float(random.normal(self.bias_mean, self.bias_stddev))
        return -bias if random.random() < 0.5 else bias

    def wandered(self, bias: float, dt: float, normal: float) -> float:
        """Return the bias `dt` seconds later; `normal` is a draw from the standard normal distribution.

        A Gauss-Markov process of first order, sampled exactly: b' = exp(-dt/tau) b + sigma_d n with
        sigma_d^2 = sigma^2 tau/2 (1 - exp(-2 dt/tau)); see the IMU noise model of Kalibr.
        """
        if not self.wanders or dt <= 0.0:
            return bias
        sigma, tau = self.dynamic_bias_stddev, self.dynamic_bias_correlation_time
        spread = sigma * math.sqrt(-tau / 2.0 * math.expm1(-2.0 * dt / tau))
        return math.exp(-dt / tau) * bias + spread * normal

    def quantized(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return `values` rounded to multiples of the precision, halves away from zero."""
        if self.precision <= COARSEST_IGNORED:
            return values
        steps = values / self.precision
        return np.copysign(np.floor(np.abs(steps) + 0.5), steps) * self.precision

    def apply(self, values: NDArray[np.float64], bias: float, random: np.random.Generator) -> NDArray[np.float64]:
        """Return `values` with noise; always draws one number per value."""
        return self.quantized(values + (bias + self.mean + self.stddev * random.standard_normal(values.shape)))


class Channels:
    """The noises of a sensor that measures a few numbers, and their present biases.

    What one channel draws does not depend on the noise of the others, nor on who listened before: white noise is
    drawn anew for each update from the number of that update, and `advance` moves the wandering biases at every
    update that was due, heard or not.
    """

    def __init__(self, sensor: SensorBase, noises: Sequence[tuple[str, Noise]]) -> None:
        """`noises` in the order of the numbers that `apply` will be given; channels of one name have one bias."""
        self._sensor = sensor
        self._names = [name for name, _ in noises]
        self._each = [noise for _, noise in noises]
        self.silent = all(noise.silent for noise in self._each)
        self._white = any(noise.stddev > 0.0 for noise in self._each)
        self._wanders = any(noise.wanders for noise in self._each)
        self._mean = np.array([noise.mean for noise in self._each])
        self._stddev = np.array([noise.stddev for noise in self._each])
        self.bias = np.zeros(len(self._each))
        """The present bias of each channel."""

    def start(self) -> None:
        """Draw the biases of a run."""
        for index, (name, noise) in enumerate(zip(self._names, self._each, strict=True)):
            self.bias[index] = noise.draw_bias(self._sensor.constant_random(f"bias of {name}"))

    def advance(self, dt: float) -> None:
        """Let the biases wander for `dt` seconds."""
        if not self._wanders or dt <= 0.0:
            return
        draws = self._sensor.random("dynamic bias").standard_normal(len(self._each)).tolist()
        biases = self.bias.tolist()
        self.bias[:] = [
            noise.wandered(bias, dt, draw) for noise, bias, draw in zip(self._each, biases, draws, strict=True)
        ]

    def apply(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the numbers with the noise of the current update."""
        if self.silent:
            return values
        noisy = values + self.bias + self._mean
        if self._white:
            noisy += self._stddev * self._sensor.random().standard_normal(len(self._each))
        for index, noise in enumerate(self._each):
            if noise.precision > 0.0:
                noisy[index : index + 1] = noise.quantized(noisy[index : index + 1])
        return noisy
