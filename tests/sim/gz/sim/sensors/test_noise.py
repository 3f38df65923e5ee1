"""Sensor noise: parameters, statistics, bias."""

from __future__ import annotations

import numpy as np
import pytest

from gz.sim.errors import SdfError
from gz.sim.sdf.element import parse
from gz.sim.sensors.noise import Noise


def generator() -> np.random.Generator:
    return np.random.Generator(np.random.Philox(key=1))


def test_no_noise_element_or_type_none_changes_nothing() -> None:
    assert Noise.from_sdf(None).silent
    assert Noise.from_sdf(parse("<noise><type>none</type><stddev>1</stddev></noise>")).silent


def test_mean_and_deviation_are_those_of_the_file() -> None:
    noise = Noise.from_sdf(parse("<noise type='gaussian'><mean>0.5</mean><stddev>0.2</stddev></noise>"))
    drawn = noise.apply(np.zeros(20_000), 0.0, generator())
    assert drawn.mean() == pytest.approx(0.5, abs=0.01)
    assert drawn.std() == pytest.approx(0.2, rel=0.03)


def test_bias_has_either_sign_and_precision_rounds() -> None:
    noise = Noise(bias_mean=1.0, bias_stddev=0.01)
    random = generator()
    biases = [noise.draw_bias(random) for _ in range(50)]
    assert min(biases) < -0.9 and max(biases) > 0.9
    assert Noise(precision=0.25).apply(np.array([0.3]), 0.0, random)[0] == 0.25


@pytest.mark.parametrize("inside", ["<type>gaussian</type><stddev>-1</stddev>", "<type>gausian</type>"])
def test_impossible_noise_is_refused(inside: str) -> None:
    with pytest.raises(SdfError, match="noise"):
        Noise.from_sdf(parse(f"<noise>{inside}</noise>"))
