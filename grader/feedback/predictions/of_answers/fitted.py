"""Misconceptions with a number in them, such as which percentile: the number that fits best is found and named."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from gz_course.grader.feedback.predictions.answers import (
    COUNT,
    LAST,
    LENGTHS,
    MEAN,
    MINIMUM,
    Asked,
    Named,
    nearest_ray,
    predict,
    predicts,
)

SAMPLE = 12  # scans that are enough to find a sector; all of them confirm it
MOST_RAYS = 720  # of a scan in which sectors are looked for
STEPS = (0.02, 0.05, 0.2, 0.25, 0.5)  # [m]
PERCENTILES = (5, 10, 15, 20, 25, 30, 40, 60, 70, 75, 80, 90, 95, 99)


def _best(asked: Asked, candidates: Iterable[Named]) -> Named:
    """Return the candidate that meets most answers."""
    return max(candidates, key=lambda each: asked.met(each.answers))


def _ranked(valid: np.ndarray, place: int) -> float:
    return float(np.partition(valid, place - 1)[place - 1])


def _average_of_smallest(valid: np.ndarray, count: int) -> float:
    return float(np.sort(valid)[:count].mean())


def _smallest_average(valid: np.ndarray, width: int) -> float:
    return float(sliding_window_view(valid, width).mean(axis=1).min())


@predicts("a percentile of the valid ranges", only=LENGTHS, rank=LAST)
def percentile(asked: Asked) -> Named:
    words = "the {}th percentile of the valid ranges"
    return _best(asked, [Named(words.format(q), asked.of_valid(partial(np.percentile, q=q))) for q in PERCENTILES])


@predicts("one of the smallest valid ranges", only=(MINIMUM,), rank=LAST)
def one_of_the_smallest(asked: Asked) -> Named:
    words = "number {} of the valid ranges in the order of their size, not the smallest"
    return _best(asked, [Named(words.format(k), asked.of_valid(partial(_ranked, place=k))) for k in range(3, 13)])


@predicts("the average of the smallest valid ranges", only=LENGTHS, rank=LAST)
def average_of_the_smallest(asked: Asked) -> Named:
    words = "the average of the {} smallest valid ranges"
    counts = (2, 3, 4, 5, 6, 8, 10, 15, 20, 30, 50)
    return _best(
        asked, [Named(words.format(n), asked.of_valid(partial(_average_of_smallest, count=n))) for n in counts]
    )


@predicts("the smallest of smoothed ranges", only=(MINIMUM,), rank=LAST)
def smoothed(asked: Asked) -> Named:
    words = "the smallest of averages over {} rays side by side, not of the ranges themselves"
    widths = (2, 3, 4, 5, 7, 9, 10, 11, 15, 20)
    return _best(asked, [Named(words.format(w), asked.of_valid(partial(_smallest_average, width=w))) for w in widths])


@predicts("those of some of the rays", rank=LAST)
def every_nth_ray(asked: Asked) -> Named:
    words = "those of one ray in {} only"
    steps = (*range(3, 13), 15, 18, 20, 24, 30, 36)
    return _best(asked, [Named(words.format(n), _of_chosen(asked, np.arange(0, MOST_RAYS, n))) for n in steps])


def _of_chosen(asked: Asked, chosen: np.ndarray) -> np.ndarray:
    """Return the statistic that is asked for over the rays with these numbers, as far as there are such."""

    def value(row: np.ndarray, low: float, high: float) -> float:
        some = row[chosen[chosen < len(row)]]
        return asked.of(some[(some > low) & (some < high)])

    return asked.each(value)


@predicts("rounded to multiples", rank=2)
def multiples(asked: Asked) -> Named:
    steps = (5, 10, 100) if asked.statistic == COUNT else STEPS
    return _best(
        asked, [Named(f"rounded to multiples of {step:g}", np.round(asked.truth / step) * step) for step in steps]
    )


@predicts("the range of one ray", only=LENGTHS, rank=LAST)
def one_ray(asked: Asked) -> Named:
    scans = asked.scans
    if scans is None or len({len(row) for row in scans.rows}) != 1:
        return Named("", asked.unknown)
    table = np.array(scans.rows)
    met = np.sum(np.abs(table - asked.given[:, None]) <= asked.tolerance, axis=0)
    ray = int(met.argmax())
    return Named(f"the range of ray {ray}, whichever is the one asked for", table[:, ray])


predict(
    "the range opposite the nearest",
    lambda asked: asked.each(
        lambda row, low, high: float(row[(nearest_ray(row, low, high) + len(row) // 2) % len(row)])
    ),
    (MINIMUM,),
)


@predicts("those of the rays within another bound", rank=LAST)
def another_bound(asked: Asked) -> Named:
    words = "those of the rays {} {:g} m, another bound than range_min and range_max"
    if asked.scans is None:
        return Named("", asked.unknown)
    limits = np.concatenate([np.arange(0.05, 2.0, 0.05), np.arange(2.0, asked.scans.high.max(), 0.5)])
    tables = np.array([_within_and_beyond(asked.statistic, valid, limits) for valid in asked.scans.valid])
    candidates = []
    for i, side in enumerate(("within", "beyond")):
        candidates += [Named(words.format(side, limit), tables[:, i, k]) for k, limit in enumerate(limits)]
    return _best(asked, candidates)


def _within_and_beyond(statistic: str, valid: np.ndarray, limits: np.ndarray) -> np.ndarray:
    """Return the statistic of the ranges within and beyond each limit [m], shape (2, limits)."""
    ranges = np.sort(valid)
    places = np.searchsorted(ranges, limits)
    counts = np.array([places, len(ranges) - places], dtype=float)
    if statistic == COUNT:
        return counts
    if statistic == MINIMUM:
        padded = np.append(ranges, np.nan)
        return np.array([np.where(places > 0, padded[0], np.nan), padded[places]])
    sums = np.concatenate([[0.0], np.cumsum(ranges)])
    return np.array([sums[places], sums[-1] - sums[places]]) / counts


@predicts("cut to a largest value", rank=2)
def never_above(asked: Asked) -> Named:
    limit = float(np.nanmax(asked.given, initial=-np.inf))
    return Named(f"never above {limit:.4g}: a larger right value became that", _cut(asked, np.minimum, limit))


@predicts("cut to a smallest value", rank=2)
def never_below(asked: Asked) -> Named:
    limit = float(np.nanmin(asked.given, initial=np.inf))
    return Named(f"never below {limit:.4g}: a smaller right value became that", _cut(asked, np.maximum, limit))


def _cut(asked: Asked, function: np.ufunc, limit: float) -> np.ndarray:
    """Return the right values with a limit; NaN if it leaves few as they are, because that is a constant."""
    cut = np.asarray(function(asked.truth, limit))
    kept = np.mean(cut[asked.answered] == asked.truth[asked.answered])
    return cut if kept >= 0.15 else np.full(len(cut), np.nan)


@predicts("the right value, changing slowly", rank=LAST)
def changing_slowly(asked: Asked) -> Named:
    step = float(np.nanmax(np.abs(np.diff(asked.given[asked.answered])), initial=0.0))
    values = asked.truth.copy()
    for i in range(1, len(values)):
        values[i] = values[i - 1] + np.clip(values[i] - values[i - 1], -step, step)
    return Named(f"the right value, changing by at most {step:.3g} from scan to scan", values)


@predicts("the right value with a number added", rank=LAST)
def shifted(asked: Asked) -> Named:
    if np.ptp(asked.truth) <= 3 * asked.tolerance:
        return Named("", asked.unknown)
    number = float(np.nanmedian(asked.given - asked.truth))
    return Named(f"the right value with the same number added each time, {number:.3g}", asked.truth + number)


@predicts("the right value times a factor", rank=LAST)
def in_proportion(asked: Asked) -> Named:
    factor = float(np.nanmedian(asked.given / asked.truth))
    if np.ptp(asked.truth) <= 3 * asked.tolerance or abs(factor) <= 1e-3:
        return Named("", asked.unknown)
    return Named(f"the right value times the same factor each time, {factor:.4g}", asked.truth * factor)


@predicts("a multiple of the right value with a number added", rank=LAST)
def straight_line(asked: Asked) -> Named:
    known = asked.answered & np.isfinite(asked.given) & np.isfinite(asked.truth)
    truth, given = asked.truth[known], asked.given[known]
    if len(truth) < 6 or np.ptp(truth) <= 10 * asked.tolerance:
        return Named("", asked.unknown)
    order = np.argsort(truth, kind="stable")
    half = len(order) // 2
    far = order[len(order) - half :], order[:half]
    slope = float(np.median((given[far[0]] - given[far[1]]) / (truth[far[0]] - truth[far[1]])))
    offset = float(np.median(given - slope * truth))
    if abs(slope) < 1e-3 or not np.isfinite(slope * offset):
        return Named("", asked.unknown)
    sign = "plus" if offset > 0 else "less"
    return Named(f"{slope:.4g} times the right value {sign} {abs(offset):.4g}", slope * asked.truth + offset)


@predicts("those of a sector", only=(MINIMUM, MEAN, COUNT), rank=LAST)
def sector(asked: Asked) -> Named:
    """Find the rays side by side, also across the end of a scan, whose statistic is what was answered."""
    nothing = Named("", asked.unknown)
    known = np.flatnonzero(asked.answered & np.isfinite(asked.given))
    if asked.scans is None or not len(known) or len({len(row) for row in asked.scans.rows}) != 1:
        return nothing
    rays = len(asked.scans.rows[0])
    if not 2 < rays <= MOST_RAYS:
        return nothing
    met = np.zeros((rays, rays), dtype=int)
    for number in known[np.linspace(0, len(known) - 1, min(SAMPLE, len(known))).astype(int)]:
        found = _of_sectors(asked, int(number))
        met += np.abs(found - asked.given[number]) <= asked.tolerance
    first, last = _usual(met == met.max())
    chosen = np.arange(first, first + last + 1) % rays
    which = f"rays {first} to {chosen[-1]}"
    only = f"{which} only" if np.sum(met == met.max()) == 1 else f"a part of the rays only, such as {which}"
    words = f"those of {only}; a scan has {rays}, from 0 to {rays - 1}"
    return Named(words, _of_chosen(asked, chosen))


def _usual(fits: np.ndarray) -> tuple[int, int]:
    """Return the first ray, and the width less 1, of a sector that fits: a round one about an axis, or the widest."""
    rays = len(fits)
    for degrees in (180, 120, 90, 60, 45, 40, 30, 20, 10):
        width = round(rays * degrees / 360)
        for middle in (0, rays // 2, rays // 4, 3 * rays // 4):
            first = (middle - width // 2) % rays
            if 2 < width < rays and fits[first, width - 1]:
                return first, width - 1
    first, last = max(zip(*np.nonzero(fits), strict=True), key=lambda place: place[1])
    return int(first), int(last)


def _of_sectors(asked: Asked, number: int) -> np.ndarray:
    """Return the statistic of one scan over each sector, shape (rays, rays): by its first ray and its width less 1."""
    assert asked.scans is not None
    row, low, high = asked.scans.rows[number], asked.scans.low[number], asked.scans.high[number]
    valid = (row > low) & (row < high)
    rays = len(row)
    twice = np.concatenate([np.where(valid, row, np.inf)] * 2)[:-1]
    windows = sliding_window_view(twice, rays)
    if asked.statistic == MINIMUM:
        return np.asarray(np.minimum.accumulate(windows, axis=1))
    counts = np.cumsum(np.isfinite(windows), axis=1)
    if asked.statistic == COUNT:
        return counts.astype(float)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.cumsum(np.where(np.isfinite(windows), windows, 0.0), axis=1) / counts)
