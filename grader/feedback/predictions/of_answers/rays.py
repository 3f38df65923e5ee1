"""The right statistic of the wrong rays: a wrong bound, a sector, a ray too few, what a loop over the rays leaves."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from gz_course.grader.feedback.predictions.answers import (
    COUNT,
    LAST,
    LENGTHS,
    MEAN,
    MINIMUM,
    Asked,
    Named,
    predict,
    predicts,
)

Choice = Callable[[np.ndarray, float, float], np.ndarray]
KEPT = (0.5, 0.9, 0.8, 0.7, 0.95)  # shares of the old value


def _mask(row: np.ndarray, low: float, high: float) -> np.ndarray:
    return np.asarray((row > low) & (row < high))


@predicts("those of the rays before the first invalid one: a break or return ends the loop there", rank=0)
def until_an_invalid_ray(asked: Asked) -> np.ndarray:
    def choice(row: np.ndarray, low: float, high: float) -> np.ndarray:
        valid = _mask(row, low, high)
        return row[: int(np.argmin(valid)) if not valid.all() else len(row)]

    return asked.over(choice)


@predicts("those of the rays after the last invalid one: the list is emptied at each invalid ray", rank=0)
def since_an_invalid_ray(asked: Asked) -> np.ndarray:
    def choice(row: np.ndarray, low: float, high: float) -> np.ndarray:
        invalid = np.flatnonzero(~_mask(row, low, high))
        return row[invalid[-1] + 1 if len(invalid) else 0 :]

    return asked.over(choice)


@predicts("a filter along the rays of a scan", only=LENGTHS)
def filtered_along_the_rays(asked: Asked) -> Named:
    words = "{:g} of the last result plus {:g} of each next ray: the last rays count most, which is no average"
    candidates = [
        Named(words.format(keep, 1 - keep), asked.of_valid(partial(_filtered, keep=keep, start=start)))
        for keep in KEPT
        for start in (None, 0.0)
    ]
    return max(candidates, key=lambda each: asked.met(each.answers))


def _filtered(valid: np.ndarray, keep: float, start: float | None) -> float:
    value = valid[0] if start is None else start
    for each in valid[-200:]:  # what came before has no weight
        value = keep * value + (1 - keep) * each
    return float(value)


predict(
    "the average of the different values among the valid ranges: a set holds each value once",
    lambda asked: max((asked.of_valid(partial(_distinct, digits=digits)) for digits in (1, 2, 0)), key=asked.met),
    (MEAN,),
    rank=2,
)


def _distinct(valid: np.ndarray, digits: int) -> float:
    return float(np.unique(np.round(valid, digits)).mean())


@predicts("the smallest of the averages of a few sectors, not of the ranges themselves", only=(MINIMUM,), rank=LAST)
def nearest_sector(asked: Asked) -> np.ndarray:
    def smallest(parts: int) -> Callable[[np.ndarray, float, float], float]:
        def value(row: np.ndarray, low: float, high: float) -> float:
            return min(float(part[_mask(part, low, high)].mean()) for part in np.array_split(row, parts))

        return value

    return max((asked.each(smallest(parts)) for parts in (2, 3, 4, 5, 6, 8, 10, 12, 16, 36)), key=asked.met)


def _valid(row: np.ndarray, low: float, high: float) -> np.ndarray:
    return row[(row > low) & (row < high)]


predict(
    "those of all rays, the invalid ones (inf, -inf, nan) included",
    lambda asked: asked.over(lambda row, low, high: row),
)


@predicts("those of all rays but nan: inf and -inf are included")
def all_but_nan(asked: Asked) -> np.ndarray:
    if asked.scans is None or not any(np.isnan(row).any() for row in asked.scans.rows):
        return asked.unknown
    return asked.over(lambda row, low, high: row[~np.isnan(row)])


predict(
    "those of the rays above range_min: range_max was not asked about, so inf is included",
    lambda asked: asked.over(lambda row, low, high: row[row > low]),
)
predict(
    "those of the rays below range_max: range_min was not asked about, so -inf is included",
    lambda asked: asked.over(lambda row, low, high: row[row < high]),
)


@predicts("those of the rays whose range lies between angle_min and angle_max: these are bounds of the angles [rad]")
def bounds_of_the_angles(asked: Asked) -> np.ndarray:
    if asked.scans is None:
        return asked.unknown
    least, most = float(asked.scans.angle_min[0]), float(asked.scans.angle_max[0])
    return asked.over(lambda row, low, high: row[(row >= least) & (row <= most)])


predict(
    "those of the invalid rays: the condition is the wrong way round",
    lambda asked: asked.over(lambda row, low, high: row[~((row > low) & (row < high))]),
)
predict(
    "those with inf counted as range_max",
    lambda asked: asked.over(lambda row, low, high: np.where(np.isposinf(row), high, row)[~np.isneginf(row)]),
    LENGTHS,
)
predict(
    "those with every range clipped to range_min and range_max: inf became range_max, -inf range_min",
    lambda asked: asked.over(
        lambda row, low, high: np.clip(np.nan_to_num(row, nan=high, posinf=high, neginf=low), low, high)
    ),
    LENGTHS,
    rank=2,
)
predict(
    "those with inf replaced by a huge number, as nan_to_num() does",
    lambda asked: asked.over(lambda row, low, high: np.nan_to_num(row)),
    LENGTHS,
)


@predicts("those of the rays below a bound", rank=LAST)
def below_another_bound(asked: Asked) -> Named:
    """Find a bound of one's own in place of range_max, where range_min was not asked about."""
    words = "those of all rays below {:g} m, -inf included: neither range_min nor range_max was asked about"
    if asked.scans is None:
        return Named("", asked.unknown)
    if not np.isfinite(asked.given[asked.answered]).any():  # any bound fits
        return Named(
            words.replace("{:g} m", "a bound of your own"), asked.over(_below(float(asked.scans.high.min()) / 2))
        )
    limits = np.arange(0.5, asked.scans.high.max(), 0.5)
    found = [Named(words.format(limit), asked.over(_below(limit))) for limit in limits]
    return max(found, key=lambda each: asked.met(each.answers))


def _below(limit: float) -> Choice:
    return lambda row, low, high: row[row < limit]


predict(
    "those with 0 in place of the ranges that are not valid",
    lambda asked: asked.over(lambda row, low, high: np.where((row > low) & (row < high), row, 0.0)),
    LENGTHS,
)
predict(
    "those of the first half of the rays only",
    lambda asked: asked.over(lambda row, low, high: _valid(row[: len(row) // 2], low, high)),
)
predict(
    "those of the second half of the rays only",
    lambda asked: asked.over(lambda row, low, high: _valid(row[len(row) // 2 :], low, high)),
)
predict("those of every second ray only", lambda asked: asked.over(lambda row, low, high: _valid(row[::2], low, high)))
predict(
    "those of all rays but the first: indices begin at 0",
    lambda asked: asked.over(lambda row, low, high: _valid(row[1:], low, high)),
    (MEAN,),
)
predict(
    "those of all rays but the last: range(n) ends before n",
    lambda asked: asked.over(lambda row, low, high: _valid(row[:-1], low, high)),
    (MEAN,),
)
predict(
    "the average of a sum that begins with the first valid range and adds it again",
    lambda asked: asked.of_valid(lambda valid: (valid.sum() + valid[0]) / len(valid)),
    (MEAN,),
)
predict(
    "one less than the number of all rays: the rays were not looked at",
    lambda asked: asked.of_rows(lambda row: len(row) - 1),
    (COUNT,),
)
predict(
    "the number of groups of valid rays side by side, not of the rays",
    lambda asked: asked.each(
        lambda row, low, high: float(np.sum(np.diff(((row > low) & (row < high)).astype(int), prepend=0) == 1))
    ),
    (COUNT,),
)


@predicts("those of the rays ahead only, not of those all around", rank=2)
def ahead(asked: Asked) -> Named:
    """Return the answers of the sector, of the usual ones, that fits best; several may fit as well."""
    if asked.scans is None or asked.scans.angle_max[0] - asked.scans.angle_min[0] < np.pi:
        return Named("", asked.unknown)
    sector = (asked.scans.angle_max[0] - asked.scans.angle_min[0]) / 2
    found: list[tuple[int, int, np.ndarray]] = []
    for degrees in (5, 10, 15, 20, 30, 45, 60, 90):
        for last in (0, 1):  # a slice leaves its last ray out

            def in_sector(
                row: np.ndarray, low: float, high: float, degrees: int = degrees, last: int = last
            ) -> np.ndarray:
                middle, half = len(row) // 2, round(len(row) / 2 * np.radians(degrees) / sector)
                return _valid(row[middle - half : middle + half + last], low, high)

            answers = asked.over(in_sector)
            found.append((asked.met(answers), degrees, answers))
    most = max(met for met, _, _ in found)
    widths = sorted({degrees for met, degrees, _ in found if met == most})
    width = f"{widths[0]}" if len(widths) == 1 else f"{widths[0]} to {widths[-1]}"
    words = f"those of the rays ahead only, within {width} degrees of straight ahead, not of those all around"
    return Named(words, next(answers for met, _, answers in found if met == most))


@predicts("those of a part of the rays only, not of those all around", rank=2)
def part_of_the_circle(asked: Asked) -> Named:
    words = "those of a part of the rays only, such as {:.0%} of them from {:.0%} on, where the first ray is 0%"
    eighths = [(i, i + width) for width in range(7, 0, -1) for i in range(9 - width)]
    found = [Named(words.format((end - i) / 8, i / 8), asked.over(_slice(i, end))) for i, end in eighths]
    return max(found, key=lambda each: asked.met(each.answers))


def _slice(begin: int, end: int) -> Choice:
    """Return the choice of the valid rays between two eighths of a scan."""
    return lambda row, low, high: _valid(row[len(row) * begin // 8 : len(row) * end // 8], low, high)


predict(
    "the sum of the valid ranges divided by the number of all rays, not of the valid ones",
    lambda asked: asked.of_valid(np.sum) / asked.of_rows(len),
    (MEAN,),
)


@predicts(
    "the average over one ray too few or too many: the sum is right, the number it is divided by is not", (MEAN,), 2
)
def divided_by_one_less(asked: Asked) -> np.ndarray:
    sums, counts = asked.of_valid(np.sum), asked.of_valid(len)
    near = [sums / (counts + off) for off in (-1, 1)]
    return (
        near[0] if np.nanmean(np.abs(near[0] - asked.given)) <= np.nanmean(np.abs(near[1] - asked.given)) else near[1]
    )
