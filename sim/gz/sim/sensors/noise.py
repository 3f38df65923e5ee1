"""Gaussian sensor noise as SDF describes it: mean, standard deviation, a bias drawn once, precision.

A sensor reads its `<noise>` with `Noise.from_sdf` and applies it to the numbers it measured.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gz.sim.sdf.element import Element


@dataclass(frozen=True)
class Noise:
    """`mean` and `stddev` in the unit of the measured quantity; `precision` > 0 rounds to its multiples."""

    mean: float = 0.0
    stddev: float = 0.0
    bias_mean: float = 0.0
    bias_stddev: float = 0.0
    precision: float = 0.0

    @classmethod
    def from_sdf(cls, element: Element | None) -> Noise:
        """Read a `<noise>` element (None, or type none: no noise); raise `SdfError` for a negative
        deviation.
        """
        if element is None:
            return cls()
        kind = element.text_of("type") or element.attributes.get("type", "none")
        if kind == "none":
            return cls()
        if kind not in ("gaussian", "gaussian_quantized"):
            raise element.error(f"noise type '{kind}' is not known; use gaussian or none")
        noise = cls(
            element.number("mean", 0.0),
            element.number("stddev", 0.0),
            element.number("bias_mean", 0.0),
            element.number("bias_stddev", 0.0),
            element.number("precision", 0.0),
        )
        if noise.stddev < 0.0 or noise.bias_stddev < 0.0 or not np.all(np.isfinite(list(vars(noise).values()))):
            raise element.error("noise deviations must be finite and not negative")
        return noise

    @property
    def silent(self) -> bool:
        """True when applying it changes nothing."""
        return self == Noise()

    def draw_bias(self, random: np.random.Generator) -> float:
        """Return the constant bias of one run; its sign is random."""
        if self.bias_mean == 0.0 and self.bias_stddev == 0.0:
            return 0.0
        bias = float(random.normal(self.bias_mean, self.bias_stddev))
        return -bias if random.random() < 0.5 else bias

    def apply(self, values: NDArray[np.float64], bias: float, random: np.random.Generator) -> NDArray[np.float64]:
        """Return `values` with noise; always draws one number per value."""
        noisy = values + (bias + self.mean + self.stddev * random.standard_normal(values.shape))
        return np.round(noisy / self.precision) * self.precision if self.precision > 0.0 else noisy
