"""Plots as SVG: where a sample, a band and a verdict come to lie, and that no number can break them."""

import math
import re
from xml.etree import ElementTree as XML

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from gz_course.grader.report.html.plot import (
    BOTTOM,
    HEIGHT,
    LEFT,
    MOST_TICKS,
    RIGHT,
    TOP,
    WIDTH,
    Area,
    Curve,
    Moment,
    key,
    plot,
    ticks,
)  # fmt: skip

numbers = st.floats(allow_nan=True, allow_infinity=True)


def curve(*samples, name="speed"):
    times, values = zip(*samples, strict=True) if samples else ((), ())
    return Curve(name, np.array(times, dtype=float), np.array(values, dtype=float))


def drawn(curves=(), areas=(), moment=None, end=10.0, until=math.inf, alt="a plot"):
    return XML.fromstring(plot(list(curves), list(areas), moment, end, until, alt))


def corners(path):
    """The corners (x, y) of a step line, from its M, H and V."""
    x, y, found = 0.0, 0.0, []
    for letter, first, second in re.findall(r"([MHV])(-?[\d.]+)(?: (-?[\d.]+))?", path):
        x, y = (
            (float(first), float(second))
            if letter == "M"
            else (float(first), y)
            if letter == "H"
            else (x, float(first))
        )
        found.append((x, float(y)))
    return found


def x_of(time, end=10.0):
    return LEFT + (WIDTH - LEFT - RIGHT) * time / end


def test_a_sample_holds_until_the_next():
    (path,) = drawn([curve((0, 0.0), (5, 1.0))]).findall("path")
    points = corners(path.get("d"))
    (x0, low), *_, (x1, high) = points
    assert (x0, x1) == (x_of(0), x_of(10))
    assert low > high, "larger values lie higher"
    assert (x_of(5), low) in points and (x_of(5), high) in points


def test_a_curve_ends_with_the_simulation():
    (path,) = drawn([curve((0, 0.0), (2, 1.0))], until=3.0).findall("path")
    assert corners(path.get("d"))[-1][0] == x_of(3)


@pytest.mark.parametrize("peak", range(5000, 5010))
def test_a_peak_between_two_pixels_is_not_lost(peak):
    samples = [(i / 1000, 0.0) for i in range(10_000)]
    samples[peak] = (peak / 1000, 1.0)
    (path,) = drawn([curve(*samples)]).findall("path")
    heights = {y for _, y in corners(path.get("d"))}
    assert len(heights) == 2
    assert len(path.get("d")) < 20_000


def test_the_band_lies_where_it_is_wanted():
    picture = drawn([curve((0, 0.0), (5, 1.0))], [Area(0.0, 1.0, 2.0, 6.0)])
    (band,) = picture.findall("rect")
    left, top, width, height = (float(band.get(name)) for name in ("x", "y", "width", "height"))
    assert (left, left + width) == pytest.approx((x_of(2), x_of(6)))
    levels = [y for _, y in corners(picture.find("path").get("d"))]
    assert (top, top + height) == (min(levels), pytest.approx(max(levels), abs=0.1001))  # each is rounded


def test_an_open_band_reaches_the_edge():
    (band,) = drawn([curve((0, 0.0), (5, 1.0))], [Area(0.5, math.inf, 0.0, 10.0)]).findall("rect")
    assert float(band.get("y")) == TOP


def test_a_band_of_one_moment_can_be_seen():
    (band,) = drawn([curve((0, 0.0))], [Area(0.0, 1.0, 10.0, 10.0)]).findall("rect")
    assert float(band.get("width")) >= 2


@pytest.mark.parametrize(("passed", "word"), [(True, "pass"), (False, "FAIL")])
def test_the_verdict_is_a_line_and_a_word(passed, word):
    picture = drawn([curve((0, 0.0))], moment=Moment(2.5, passed))
    (line,) = [line for line in picture.findall("line") if line.get("class") == word]
    assert float(line.get("x1")) == pytest.approx(x_of(2.5), abs=0.06)
    assert f"{word} at 2.50 s" in [text.text for text in picture.findall("text")]


def test_curves_differ_in_more_than_their_place():
    paths = drawn([curve((0, 0.0)), curve((0, 1.0))]).findall("path")
    assert [path.get("class") for path in paths] == ["curve c0", "curve c1"]
    assert "curve c1" in key(1)


def test_it_says_in_words_what_it_shows():
    picture = drawn(alt='"<speed>" & more')
    assert (picture.get("role"), picture.get("aria-label")) == ("img", '"<speed>" & more')


def test_the_noise_of_computing_is_not_blown_up():
    (path,) = drawn([curve((0, 0.0), (1, 1e-17), (2, -1e-17))]).findall("path")
    assert len({y for _, y in corners(path.get("d"))}) == 1


@given(
    samples=st.lists(st.tuples(st.floats(0, 1e4), numbers), max_size=30),
    bounds=st.lists(st.tuples(numbers, numbers, numbers, numbers), max_size=3),
    at=numbers, end=numbers, until=numbers,
)  # fmt: skip
@example(samples=[(0.0, 1.0)], bounds=[], at=0.0, end=1.0, until=math.nan)
@example(samples=[(0.0, math.inf), (1.0, -math.inf)], bounds=[], at=math.nan, end=5e-324, until=1.0)
@example(samples=[(0.0, 0.0)], bounds=[(-math.inf, math.inf, -math.inf, math.inf)], at=1e308, end=1.8e308, until=1.0)
@example(samples=[(0.0, 0.0)], bounds=[(0.0, 1.0, 0.0, 1.0)], at=1.0, end=1.79e308, until=1.0)
def test_no_number_breaks_it(samples, bounds, at, end, until):
    areas = [Area(*sorted(b[:2]), *b[2:]) for b in bounds if not any(math.isnan(v) for v in b)]
    picture = drawn([curve(*sorted(samples))], areas, Moment(at, False), end, until)
    text = XML.tostring(picture, encoding="unicode")
    assert not re.search("nan|inf", text), text
    for path in picture.findall("path"):
        for x, y in corners(path.get("d")):
            assert LEFT <= x <= WIDTH - RIGHT + 0.1 and TOP - 0.1 <= y <= HEIGHT - BOTTOM + 0.1


@given(low=st.floats(-1e9, 1e9), span=st.floats(1e-6, 1e9))
def test_ticks_are_few_round_and_within(low, span):
    high = low + span
    found = ticks(low, high)
    assert 1 <= len(found) <= MOST_TICKS + 1
    slack = 1e-6 * span + 1e-12 * max(abs(low), abs(high))
    assert all(low - slack <= tick <= high + slack for tick in found)


def test_ticks_are_what_one_would_write_at_an_axis():
    assert ticks(0, 8) == [0, 2, 4, 6, 8]
    assert ticks(-0.04, 0.54) == pytest.approx([0, 0.1, 0.2, 0.3, 0.4, 0.5])
    assert ticks(1, 1) == [1]
