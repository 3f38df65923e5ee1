"""Plots of signals over simulated time as SVG: step lines, the band they should be in, the moment of the verdict.

Used by `page.py`; the result is markup for an HTML page whose style sheet defines the colours of the classes. Lines
differ in dashes as well as in colour.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup, escape

WIDTH, HEIGHT = 720, 206
# [pixels] Margins around the plotting area, with room for the larger labels of a narrow page.
LEFT, RIGHT, TOP, BOTTOM = 66, 14, 25, 48
HUGE = 1e150  # larger values are clipped to this, so that their differences stay finite
MOST_TICKS, MOST_LEVELS = 6, 4  # along time, and along the values
NARROWEST = 10.0  # [pixels] smallest visible width of a band
FLAT = 1e-6  # a smaller range is a constant with rounding errors
COLUMN = 0.5  # [pixels] samples within this distance are drawn as one


@dataclass(frozen=True)
class Curve:
    """One signal to draw: `times` [s] (n,) sorted, `values` (n,), each valid until the next."""

    name: str
    times: np.ndarray
    values: np.ndarray


@dataclass(frozen=True)
class Area:
    """The band the first curve should be in: `low` to `high` from `start` to `end` [s]; infinite bounds are open."""

    low: float
    high: float
    start: float
    end: float


@dataclass(frozen=True)
class Moment:
    """The time of a verdict [s], and whether the check passed."""

    at_s: float
    passed: bool


def plot(
    curves: Sequence[Curve], areas: Sequence[Area], moment: Moment | None, end_s: float, until_s: float, alt: str
) -> Markup:
    """Return one plot as an SVG element, from 0 to `end_s` [s]; the last values hold until `until_s` [s].

    `alt` is its text alternative.
    """
    end_s = end_s if 0 < end_s < HUGE else 1.0
    until_s = until_s if until_s < end_s else end_s
    curves = [_drawable(curve) for curve in curves]
    low, high = _range([*(c.values for c in curves), *_edges(areas)])

    def x(time: float) -> float:
        return LEFT + (WIDTH - LEFT - RIGHT) * min(max(time / end_s, 0.0), 1.0)

    def y(value: float) -> float:
        share = min(max((value - low) / (high - low), 0.0), 1.0)
        return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * share

    parts = [f'<svg class="plot" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{escape(alt)}">']
    for area in areas:
        left, right = x(area.start), x(area.end)
        above, below = y(min(area.high, high)), y(max(area.low, low))
        if right - left < NARROWEST:  # a single moment, marked by the line of the verdict
            left, right = left - NARROWEST / 2, left + NARROWEST / 2
        width, height = right - left, max(below - above, 2.0)
        parts.append(f'<rect class="band" x="{left:.1f}" y="{above:.1f}" width="{width:.1f}" height="{height:.1f}"/>')
    for value in ticks(low, high, MOST_LEVELS):
        level = f"{y(value):.1f}"
        parts.append(f'<line class="grid" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{level}" y2="{level}"/>')
        parts.append(
            f'<text class="tick" x="{LEFT - 6}" y="{level}" dy=".35em" text-anchor="end">{number(value)}</text>'
        )
    for time in ticks(0.0, end_s):
        place = f"{x(time):.1f}"
        parts.append(f'<line class="grid" x1="{place}" x2="{place}" y1="{TOP}" y2="{HEIGHT - BOTTOM}"/>')
        parts.append(
            f'<text class="tick" x="{place}" y="{HEIGHT - BOTTOM + 19}" text-anchor="middle">{number(time)}</text>'
        )
    middle = (LEFT + WIDTH - RIGHT) / 2
    parts.append(f'<text class="tick" x="{middle:.0f}" y="{HEIGHT - 5}" text-anchor="middle">simulated time [s]</text>')
    for index, curve in enumerate(curves):
        steps = _steps([x(t) for t in curve.times.tolist()], [y(v) for v in curve.values.tolist()], x(until_s))
        if steps:
            parts.append(f'<path class="curve c{index % 4}" d="{steps}"/>')
    if moment is not None and math.isfinite(moment.at_s):
        given, word = x(moment.at_s), "pass" if moment.passed else "FAIL"
        anchor = "end" if given > WIDTH / 2 else "start"
        parts.append(f'<line class="{word}" x1="{given:.1f}" x2="{given:.1f}" y1="{TOP}" y2="{HEIGHT - BOTTOM}"/>')
        text = f"{word} at {moment.at_s:.2f} s"
        parts.append(f'<text class="{word}" x="{given:.1f}" y="{TOP - 6}" text-anchor="{anchor}">{text}</text>')
    return Markup("".join([*parts, "</svg>"]))


def key(index: int) -> Markup:
    """Return a sample of the line style of curve number `index`, for the caption."""
    line = f'<path class="curve c{index % 4}" d="M0 5H28"/>'
    return Markup(f'<svg class="key" viewBox="0 0 28 10" width="28" height="10" aria-hidden="true">{line}</svg>')


def ticks(low: float, high: float, most: int = MOST_TICKS) -> list[float]:
    """Return at most `most` + 1 round numbers from `low` to `high`: multiples of 1, 2 or 5 times a power of ten."""
    span = high - low
    if not 1 / HUGE < span <= 4 * HUGE:
        return [low]
    power = 10.0 ** math.floor(math.log10(span / most))
    step = next((s for s in (power, 2 * power, 5 * power) if s > 0 and span / s <= most), 10 * power)
    if not step > 0 or abs(low) / step > 1e12:  # floating-point numbers are too coarse for ticks
        return [low, high]
    first = math.ceil(low / step - 1e-9)
    return [i * step for i in range(first, first + most + 1) if i * step <= high + step * 1e-9]


def number(value: float) -> str:
    """Return a number as the label of an axis."""
    return f"{value + 0.0:.4g}"


def _drawable(curve: Curve) -> Curve:
    seen = ~np.isnan(curve.values)
    return Curve(curve.name, curve.times[seen], np.clip(curve.values[seen], -HUGE, HUGE))


def _edges(areas: Sequence[Area]) -> list[np.ndarray]:
    edges = np.array([edge for area in areas for edge in (area.low, area.high)])
    return [np.clip(edges[np.isfinite(edges)], -HUGE, HUGE)]


def _range(values: Sequence[np.ndarray]) -> tuple[float, float]:
    """Return the ends of the value axis: the range of all values with a margin."""
    every = np.concatenate([np.asarray(v, dtype=float) for v in values]) if values else np.empty(0)
    if not len(every):
        return 0.0, 1.0
    low, high = float(every.min()), float(every.max())
    room = 0.08 * (high - low)
    if high - low < max(FLAT, 1e-9 * max(abs(low), abs(high))):  # a constant is drawn in the middle
        room = max(abs(low), abs(high), 1.0) * 0.1
    return low - room, high + room


def _steps(xs: list[float], ys: list[float], until: float) -> str:
    """Return the path of a step line; of samples in one column of pixels, draw first, lowest, highest and last."""
    if not xs:
        return ""
    last = f"{ys[0]:.1f}"
    path = [f"M{xs[0]:.1f} {last}"]
    start = 0
    for stop in range(1, len(xs) + 1):
        if stop < len(xs) and xs[stop] - xs[start] < COLUMN:
            continue
        column = ys[start:stop]
        for height in (f"{h:.1f}" for h in (column[0], min(column), max(column), column[-1])):
            if height != last:
                path.append(f"H{xs[start]:.1f}V{height}")
                last = height
        start = stop
    return "".join([*path, f"H{max(until, xs[-1]):.1f}"])
