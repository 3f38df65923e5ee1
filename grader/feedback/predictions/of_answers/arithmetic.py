"""The right value, changed by one step of arithmetic: rounded, in another unit, with another sign, scaled."""

from __future__ import annotations

import numpy as np

from gz_course.grader.feedback.predictions.answers import COUNT, LENGTHS, Asked, Named, predicts


@predicts("rounded to two decimals", only=LENGTHS)
def two_decimals(asked: Asked) -> np.ndarray:
    return np.round(asked.truth, 2)


@predicts("rounded to one decimal", only=LENGTHS)
def one_decimal(asked: Asked) -> np.ndarray:
    return np.round(asked.truth, 1)


@predicts("rounded to significant digits", only=LENGTHS, rank=2)
def significant_digits(asked: Asked) -> Named:
    scale = 10.0 ** np.floor(np.log10(np.abs(asked.truth)))
    candidates = [(digits, np.round(asked.truth / scale, digits - 1) * scale) for digits in (1, 2, 3)]
    digits, answers = max(candidates, key=lambda each: asked.met(each[1]))
    return Named(
        f"rounded to {digits} significant digit{'s' * (digits > 1)}, as .{digits - 1}e or .{digits}g do", answers
    )


@predicts("cut off after two decimals", only=LENGTHS)
def cut_off(asked: Asked) -> np.ndarray:
    return np.floor(asked.truth * 100) / 100


@predicts("cut off after one decimal", only=LENGTHS)
def cut_off_at_one(asked: Asked) -> np.ndarray:
    return np.floor(asked.truth * 10) / 10


@predicts("whole numbers: the decimals are cut off, as int() and // do", only=LENGTHS)
def whole(asked: Asked) -> np.ndarray:
    return np.floor(asked.truth)


@predicts("rounded to whole numbers", only=LENGTHS)
def rounded(asked: Asked) -> np.ndarray:
    return np.round(asked.truth)


@predicts("in millimetres; metres are asked for", only=LENGTHS)
def millimetres(asked: Asked) -> np.ndarray:
    return _scaled(asked, 1000.0)


@predicts("in centimetres; metres are asked for", only=LENGTHS)
def centimetres(asked: Asked) -> np.ndarray:
    return _scaled(asked, 100.0)


@predicts("in kilometres; metres are asked for", only=LENGTHS)
def kilometres(asked: Asked) -> np.ndarray:
    return _scaled(asked, 0.001)


@predicts("divided by 100; metres are asked for", only=LENGTHS)
def hundredths(asked: Asked) -> np.ndarray:
    return _scaled(asked, 0.01)


@predicts("in feet; metres are asked for", only=LENGTHS)
def feet(asked: Asked) -> np.ndarray:
    return _scaled(asked, 3.28084)


@predicts("twice the right value")
def doubled(asked: Asked) -> np.ndarray:
    return _scaled(asked, 2.0)


@predicts("half the right value")
def halved(asked: Asked) -> np.ndarray:
    return _scaled(asked, 0.5)


@predicts("ten times the right value")
def tenfold(asked: Asked) -> np.ndarray:
    return _scaled(asked, 10.0)


@predicts("a tenth of the right value")
def tenth(asked: Asked) -> np.ndarray:
    return _scaled(asked, 0.1)


@predicts("in degrees; radians are asked for")
def degrees(asked: Asked) -> np.ndarray:
    return np.degrees(asked.truth)


@predicts("in radians; degrees are asked for")
def radians(asked: Asked) -> np.ndarray:
    return np.radians(asked.truth)


@predicts("the right value with the wrong sign")
def negative(asked: Asked) -> np.ndarray:
    return -asked.truth


@predicts("the absolute value: the sign is lost")
def absolute(asked: Asked) -> np.ndarray:
    return np.abs(asked.truth) if (asked.truth < 0).any() else asked.unknown


@predicts("the square of the right value")
def squared(asked: Asked) -> np.ndarray:
    return asked.truth**2


@predicts("the reciprocal of the right value, 1 / x", only=LENGTHS)
def reciprocal(asked: Asked) -> np.ndarray:
    with np.errstate(divide="ignore"):
        return 1 / asked.truth


@predicts("the right value less range_min", only=LENGTHS)
def less_range_min(asked: Asked) -> np.ndarray:
    return asked.truth - asked.scans.low if asked.scans else asked.unknown


@predicts("the part of all rays that is valid, not their number", only=(COUNT,))
def share(asked: Asked) -> np.ndarray:
    return asked.truth / np.array([len(row) for row in asked.scans.rows]) if asked.scans else asked.unknown


@predicts("the percentage of all rays that is valid, not their number", only=(COUNT,))
def percentage(asked: Asked) -> np.ndarray:
    return 100 * share(asked)


@predicts("rounded up to whole numbers", only=LENGTHS)
def rounded_up(asked: Asked) -> np.ndarray:
    return np.ceil(asked.truth)


@predicts("the square root of the right value")
def square_root(asked: Asked) -> np.ndarray:
    return np.sqrt(asked.truth)


@predicts("the natural logarithm of the right value")
def logarithm(asked: Asked) -> np.ndarray:
    return np.log(asked.truth)


@predicts("whole centimetres; metres are asked for", only=LENGTHS)
def whole_centimetres(asked: Asked) -> np.ndarray:
    return np.floor(100 * asked.truth)


@predicts("whole millimetres; metres are asked for", only=LENGTHS)
def whole_millimetres(asked: Asked) -> np.ndarray:
    return np.floor(1000 * asked.truth)


@predicts("rounded up to one decimal", only=LENGTHS)
def rounded_up_at_one(asked: Asked) -> np.ndarray:
    return np.ceil(asked.truth * 10) / 10


@predicts("range_max less the right value", only=LENGTHS)
def from_range_max(asked: Asked) -> np.ndarray:
    return asked.scans.high - asked.truth if asked.scans else asked.unknown


@predicts("the right value divided by range_max", only=LENGTHS)
def part_of_range_max(asked: Asked) -> np.ndarray:
    return asked.truth / asked.scans.high if asked.scans else asked.unknown


def _scaled(asked: Asked, factor: float) -> np.ndarray:
    return asked.truth * factor
