"""Sensor noise: parameters, statistics, bias, drifting bias, precision, channels."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.plugins.noise import Channels, Noise
from gz_course.sim.gz.sim.sdf.element import parse


def generator(key: int = 1) -> np.random.Generator:
    return np.random.Generator(np.random.Philox(key=key))


def test_no_noise_element_or_type_none_changes_nothing() -> None:
    assert Noise.from_sdf(None).silent
    assert Noise.from_sdf(parse("<noise><type>none</type><stddev>1</stddev></noise>")).silent


def test_every_parameter_is_read() -> None:
    names = Noise.__dataclass_fields__
    text = "".join(f"<{name}>{index}.5</{name}>" for index, name in enumerate(names))
    noise = Noise.from_sdf(parse(f"<noise type='gaussian_quantized'>{text}</noise>"))
    assert [getattr(noise, name) for name in names] == [index + 0.5 for index in range(len(names))]
    assert len(names) == 7


def test_mean_and_deviation_are_those_of_the_file() -> None:
    noise = Noise.from_sdf(parse("<noise type='gaussian'><mean>0.5</mean><stddev>0.2</stddev></noise>"))
    drawn = noise.apply(np.zeros(20_000), 0.0, generator())
    assert drawn.mean() == pytest.approx(0.5, abs=0.01)
    assert drawn.std() == pytest.approx(0.2, rel=0.03)


def test_bias_has_either_sign_and_its_own_deviation() -> None:
    noise = Noise(bias_mean=1.0, bias_stddev=0.1)
    random = generator()
    biases = np.array([noise.draw_bias(random) for _ in range(4000)])
    assert (biases < 0).mean() == pytest.approx(0.5, abs=0.03)
    assert np.abs(biases).mean() == pytest.approx(1.0, abs=0.01)
    assert np.abs(biases).std() == pytest.approx(0.1, rel=0.05)


def test_a_bias_without_deviation_keeps_its_size() -> None:
    random = generator()
    assert {Noise(bias_mean=2.0).draw_bias(random) for _ in range(50)} == {-2.0, 2.0}


def test_precision_rounds_halves_away_from_zero() -> None:
    values = np.array((0.3, -0.3, 0.375, -0.375, 0.125, 1e9))
    assert Noise(precision=0.25).quantized(values).tolist() == [0.25, -0.25, 0.5, -0.5, 0.25, 1e9]
    # Gazebo ignores a precision of 1e-6 and less.
    assert Noise(precision=1e-6).quantized(values) is values


@given(st.floats(-1e6, 1e6), st.floats(1e-5, 1e3))
def test_rounded_values_are_multiples_and_near(value: float, precision: float) -> None:
    rounded = float(Noise(precision=precision).quantized(np.array((value,)))[0])
    assert abs(rounded - value) <= precision / 2 * (1 + 1e-6) + 1e-9
    assert rounded / precision == pytest.approx(round(rounded / precision), abs=1e-3)


def test_a_wandering_bias_has_the_spread_and_the_memory_of_its_process() -> None:
    # First order Gauss-Markov process: variance sigma^2 tau / 2, correlation exp(-t / tau), for any time step.
    sigma, tau = 0.3, 2.0
    noise = Noise(dynamic_bias_stddev=sigma, dynamic_bias_correlation_time=tau)
    for dt in (0.5, 0.05):
        draws = generator().standard_normal(int(20_000 / dt)).tolist()
        bias, path = 0.0, []
        for draw in draws:
            bias = noise.wandered(bias, dt, draw)
            path.append(bias)
        values = np.array(path)
        lag = round(tau / dt)
        assert values.var() == pytest.approx(sigma**2 * tau / 2, rel=0.05)
        correlation = float(np.corrcoef(values[:-lag], values[lag:])[0, 1])
        assert correlation == pytest.approx(math.exp(-1), abs=0.04)


def test_a_bias_does_not_wander_without_time_or_correlation_time() -> None:
    assert Noise(dynamic_bias_stddev=1.0).wandered(0.5, 0.1, 1.0) == 0.5
    noise = Noise(dynamic_bias_stddev=1.0, dynamic_bias_correlation_time=1.0)
    assert noise.wandered(0.5, 0.0, 1.0) == 0.5
    # Without random samples it only decays.
    assert noise.wandered(0.5, 1.0, 0.0) == pytest.approx(0.5 * math.exp(-1))


class Source:
    """A substitute for a sensor: its random generators by purpose and update."""

    updates = 0

    def random(self, purpose: str = "noise") -> np.random.Generator:
        return generator(hash_of(f"{purpose} {self.updates}"))

    def constant_random(self, purpose: str) -> np.random.Generator:
        return generator(hash_of(purpose))


def hash_of(text: str) -> int:
    return int.from_bytes(text.encode()[-16:], "little")


def run(channels: Channels, source: Source, count: int) -> np.ndarray:
    channels.start()
    values = []
    for update in range(count):
        source.updates = update
        channels.advance(0.01 if update else 0.0)
        values.append(channels.apply([0.0, 0.0, 0.0]))
    return np.array(values)


LOUD = Noise(stddev=1.0, bias_mean=1.0, dynamic_bias_stddev=1.0, dynamic_bias_correlation_time=1.0)


def test_one_channel_does_not_change_what_another_draws() -> None:
    def values(*noises: Noise) -> np.ndarray:
        source = Source()
        return run(Channels(source, list(zip("abc", noises, strict=True))), source, 20)  # type: ignore[arg-type]

    alone = values(LOUD, Noise(), Noise())
    together = values(LOUD, Noise(stddev=3.0, bias_mean=5.0), LOUD)
    assert (alone[:, 0] == together[:, 0]).all()
    assert (alone[:, 1:] == 0).all()
    assert len(set(together[:, 2].tolist()) & set(together[:, 0].tolist())) == 0


def test_channels_of_one_name_share_their_bias() -> None:
    source = Source()
    noise = Noise(bias_mean=1.0, bias_stddev=1.0)
    channels = Channels(source, [("x", noise), ("x", noise), ("y", noise)])  # type: ignore[arg-type]
    first, second, third = run(channels, source, 1)[0]
    assert first == second != third


def test_channels_round_each_with_their_own_precision() -> None:
    source = Source()
    channels = Channels(source, [("a", Noise(precision=0.5)), ("b", Noise()), ("c", Noise(precision=2.0))])  # type: ignore[arg-type]
    channels.start()
    assert channels.apply([0.7, 0.7, 1.7]) == [0.5, 0.7, 2.0]


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        ("<type>gaussian</type><stddev>-1</stddev>", "<stddev> of <noise> must be finite and not negative"),
        ("<type>gausian</type>", "did you mean 'gaussian'"),
        ("<type>gaussian</type><precision>-1</precision>", "<precision>"),
        ("<type>gaussian</type><bias_stddev>inf</bias_stddev>", "<bias_stddev>"),
        ("<type>gaussian</type><mean>nan</mean>", "must not be NaN"),
        ("<type>gaussian</type><mean>loud</mean>", "needs a number, got 'loud'"),
    ],
)
def test_impossible_noise_is_refused(inside: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence):
        Noise.from_sdf(parse(f"<noise>{inside}</noise>"))
