"""Gaussian sensor noise of SDF: mean, standard deviation, a bias drawn once per run, a drifting bias, and precision.

A sensor reads its `<noise>` with `Noise.from_sdf`. Sensors of a few numbers (an IMU has six) use `Channels`, with one
noise each; scans and images apply one `Noise` to all values.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/GaussianNoiseModel.cc
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.sensor import SensorBase

F = TypeVar("F", np.float32, np.float64)
KINDS = ("none", "gaussian", "gaussian_quantized")
COARSEST_IGNORED = 1e-6
"""A precision up to this value is ignored, as in Gazebo."""


@dataclass(frozen=True)
class Noise:
    """Noise parameters: `mean` and deviations in the unit of the measured quantity, `precision` > 0 as rounding step.

    `dynamic_bias_stddev` is a density [unit/sqrt(s)], `dynamic_bias_correlation_time` is in [s].
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
        """Read a `<noise>` element; without one, or with type none, there is no noise.

        Raises SdfError for an unknown type, and for a deviation, precision or time that is negative or not finite.
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
        """True if `apply` changes nothing."""
        return self == Noise()

    @property
    def wanders(self) -> bool:
        """True if the bias drifts with time."""
        return self.dynamic_bias_stddev > 0.0 and self.dynamic_bias_correlation_time > 0.0

    def draw_bias(self, random: np.random.Generator) -> float:
        """Return the bias at the start of a run, with random sign."""
        if self.bias_mean == 0.0 and self.bias_stddev == 0.0:
            return 0.0
        bias = float(random.normal(self.bias_mean, self.bias_stddev))
        return -bias if random.random() < 0.5 else bias

    def wandered(self, bias: float, dt: float, normal: float) -> float:
        """Return the bias `dt` [s] later; `normal` is a sample of the standard normal distribution.

        A Gauss-Markov process of first order, sampled exactly: b' = exp(-dt/tau) b + sigma_d n with
        sigma_d^2 = sigma^2 tau/2 (1 - exp(-2 dt/tau)).
        Source: IMU noise model of Kalibr, https://github.com/ethz-asl/kalibr/wiki/IMU-Noise-Model
        """
        if not self.wanders or dt <= 0.0:
            return bias
        sigma, tau = self.dynamic_bias_stddev, self.dynamic_bias_correlation_time
        spread = sigma * math.sqrt(-tau / 2.0 * math.expm1(-2.0 * dt / tau))
        return math.exp(-dt / tau) * bias + spread * normal

    def quantized(self, values: NDArray[F]) -> NDArray[F]:
        """Return `values` rounded to multiples of the precision, halves away from zero."""
        if self.precision <= COARSEST_IGNORED:
            return values
        steps = values / self.precision
        return np.copysign(np.floor(np.abs(steps) + 0.5), steps) * self.precision

    def apply(self, values: NDArray[F], bias: float, random: np.random.Generator) -> NDArray[F]:
        """Return `values` with noise; always draws one number per value, so that the random sequence stays the same."""
        noise: NDArray[F] = random.standard_normal(values.shape, values.dtype)
        noise *= self.stddev
        noise += bias + self.mean
        noise += values
        return self.quantized(noise)


class Channels:
    """The noises of a sensor that measures a few numbers, and their present biases.

    A channel's draws depend neither on the other channels nor on the subscribers: white noise is seeded with the
    number of the update, and `advance` moves the drifting biases at every due update, even without a subscriber.
    """

    def __init__(self, sensor: SensorBase, noises: Sequence[tuple[str, Noise]]) -> None:
        """Take `noises` in the order of the numbers given to `apply`; channels of the same name share one bias."""
        self._sensor = sensor
        self._names = [name for name, _ in noises]
        self._each = [noise for _, noise in noises]
        self.silent = all(noise.silent for noise in self._each)
        self._white = any(noise.stddev > 0.0 for noise in self._each)
        self._wanders = any(noise.wanders for noise in self._each)
        self._mean = [noise.mean for noise in self._each]
        self._stddev = [noise.stddev for noise in self._each]
        self._coarse = [(index, noise) for index, noise in enumerate(self._each) if noise.precision > 0.0]
        self.bias = [0.0] * len(self._each)
        """The present bias of each channel."""

    def start(self) -> None:
        for index, (name, noise) in enumerate(zip(self._names, self._each, strict=True)):
            self.bias[index] = noise.draw_bias(self._sensor.constant_random(f"bias of {name}"))

    def advance(self, dt: float) -> None:
        """Advance the drifting biases by `dt` [s]."""
        if not self._wanders or dt <= 0.0:
            return
        draws = self._sensor.random("dynamic bias").standard_normal(len(self._each)).tolist()
        self.bias = [
            noise.wandered(bias, dt, draw) for noise, bias, draw in zip(self._each, self.bias, draws, strict=True)
        ]

    def apply(self, values: list[float]) -> list[float]:
        """Return `values` with the noise of the current update."""
        if self.silent:
            return values
        # Plain floats are faster than arrays of six.
        noisy = [value + bias + mean for value, bias, mean in zip(values, self.bias, self._mean, strict=True)]
        if self._white:
            draws = self._sensor.random().standard_normal(len(noisy)).tolist()
            noisy = [value + stddev * draw for value, stddev, draw in zip(noisy, self._stddev, draws, strict=True)]
        for index, noise in self._coarse:
            noisy[index] = noise.quantized(np.array((noisy[index],))).item()
        return noisy
