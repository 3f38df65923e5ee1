"""Signals as steps: compared with the plainest possible reckoning, millisecond by millisecond."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Signal
from gz_course.grader.score.steps import Condition, fulfilled, value_at


def read(raw):
    (condition,) = Condition.read_all(Table({"conditions": [raw]}, "check 'it'"))
    return condition


class Made:
    """Signals by name, as a recording returns them."""

    ended_s = float("inf")

    def __init__(self, signals):
        self._signals = {
            name: Signal(np.array([t for t, _ in rows], dtype=np.int64), np.array([v for _, v in rows], dtype=float))
            for name, rows in signals.items()
        }

    def signal(self, name):
        return self._signals.get(name, Signal(np.empty(0, dtype=np.int64), np.empty(0)))


MS = 1_000_000


def within(signal, low, high):
    return read({"signal": signal, "low": low, "high": high})


SAMPLES = st.dictionaries(st.integers(0, 300), st.integers(-3, 3), max_size=12).map(
    lambda rows: [(t * MS, v) for t, v in sorted(rows.items())]
)
BAND = st.tuples(st.integers(-3, 3), st.integers(-3, 3)).map(sorted)
WINDOW = st.tuples(st.integers(0, 300), st.integers(0, 300)).map(sorted)


def held(rows, ms):
    """Value of a step function at a time, by looking at every sample."""
    value = None
    for t, v in rows:
        if t <= ms * MS:
            value = v
    return value


@settings(deadline=None, max_examples=200)
@given(SAMPLES, SAMPLES, BAND, BAND, WINDOW)
def test_time_in_band_equals_counting_every_millisecond(one, two, band_one, band_two, window):
    conditions = [within("one", *band_one), within("two", *band_two)]
    start, end = window
    edges, holds = fulfilled(Made({"one": one, "two": two}), conditions, start / 1e3, end / 1e3)
    assert len(edges) == len(holds) + 1 and edges[0] == start / 1e3 and edges[-1] == end / 1e3
    assert (np.diff(edges) >= 0).all()
    total = float(np.diff(edges)[holds].sum())
    counted = sum(
        all(
            (value := held(rows, ms)) is not None and low <= value <= high
            for rows, (low, high) in ((one, band_one), (two, band_two))
        )
        for ms in range(start, end)
    )
    assert total == pytest.approx(counted / 1e3, abs=1e-9)


@settings(deadline=None)
@given(SAMPLES, st.integers(0, 300))
def test_the_value_at_a_time_is_that_of_the_last_sample(rows, ms):
    assert value_at(Made({"a": rows}), "a", ms / 1e3) == held(rows, ms)


def test_both_bounds_belong_to_the_band():
    made = Made({"a": [(0, 0.45), (MS, 0.55), (2 * MS, 0.55 + 1e-9), (3 * MS, 0.45 - 1e-9)]})
    _, holds = fulfilled(made, [within("a", 0.45, 0.55)], 0.0, 0.004)
    assert holds.tolist() == [True, True, False, False]


@pytest.mark.parametrize(
    ("raw", "bounds", "words"),
    [
        ({"low": 1}, (1.0, np.inf), "a at least 1"),
        ({"high": 1.5, "unit": "m/s"}, (-np.inf, 1.5), "a at most 1.5 m/s"),
        ({"low": -1, "high": 1, "name": "speed", "unit": "m/s"}, (-1.0, 1.0), "speed between -1 and 1 m/s"),
    ],
)
def test_a_condition_is_read_and_told_in_words(raw, bounds, words):
    condition = read({"signal": "a"} | raw)
    assert (condition.low, condition.high) == bounds
    assert str(condition) == words


def test_before_its_first_sample_and_without_any_a_signal_fulfils_nothing():
    anything = within("a", -np.inf, np.inf)
    edges, holds = fulfilled(Made({"a": [(2 * MS, 1.0)]}), [anything], 0.0, 0.004)
    assert float(np.diff(edges)[holds].sum()) == pytest.approx(0.002)
    assert not fulfilled(Made({}), [anything], 0.0, 1.0)[1].any()


def test_a_last_sample_holds_to_the_end():
    edges, holds = fulfilled(Made({"a": [(0, 1.0)]}), [within("a", 1, 1)], 0.0, 8.0)
    assert (edges.tolist(), holds.tolist()) == ([0.0, 8.0], [True])
