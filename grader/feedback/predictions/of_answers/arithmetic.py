"""The right value, changed by one step of arithmetic, and other averages and spreads of the valid ranges."""

from __future__ import annotations

import numpy as np

from gz_course.grader.feedback.predictions.answers import COUNT, LENGTHS, MEAN, Asked, Named, predict, predicts

predict("rounded to two decimals", lambda asked: np.round(asked.truth, 2), LENGTHS)
predict("rounded to one decimal", lambda asked: np.round(asked.truth, 1), LENGTHS)


@predicts("rounded to significant digits", only=LENGTHS, rank=2)
def significant_digits(asked: Asked) -> Named:
    scale = 10.0 ** np.floor(np.log10(np.abs(asked.truth)))
    candidates = [(digits, np.round(asked.truth / scale, digits - 1) * scale) for digits in (1, 2, 3)]
    digits, answers = max(candidates, key=lambda each: asked.met(each[1]))
    return Named(
        f"rounded to {digits} significant digit{'s' * (digits > 1)}, as .{digits - 1}e or .{digits}g do", answers
    )


predict("cut off after two decimals", lambda asked: np.floor(asked.truth * 100) / 100, LENGTHS)
predict("cut off after one decimal", lambda asked: np.floor(asked.truth * 10) / 10, LENGTHS)
predict("whole numbers: the decimals are cut off, as int() and // do", lambda asked: np.floor(asked.truth), LENGTHS)
predict("rounded to whole numbers", lambda asked: np.round(asked.truth), LENGTHS)
predict("in millimetres; metres are asked for", lambda asked: asked.truth * 1000.0, LENGTHS)
predict("in centimetres; metres are asked for", lambda asked: asked.truth * 100.0, LENGTHS)
predict("in kilometres; metres are asked for", lambda asked: asked.truth * 0.001, LENGTHS)
predict("divided by 100; metres are asked for", lambda asked: asked.truth * 0.01, LENGTHS)
predict("in feet; metres are asked for", lambda asked: asked.truth * 3.28084, LENGTHS)
predict("twice the right value", lambda asked: asked.truth * 2.0)
predict("half the right value", lambda asked: asked.truth * 0.5)
predict("ten times the right value", lambda asked: asked.truth * 10.0)
predict("a tenth of the right value", lambda asked: asked.truth * 0.1)
predict("in degrees; radians are asked for", lambda asked: np.degrees(asked.truth))
predict("in radians; degrees are asked for", lambda asked: np.radians(asked.truth))
predict("the right value with the wrong sign", lambda asked: -asked.truth)
predict(
    "the absolute value: the sign is lost",
    lambda asked: np.abs(asked.truth) if (asked.truth < 0).any() else asked.unknown,
)
predict("the square of the right value", lambda asked: asked.truth**2)


@predicts("the reciprocal of the right value, 1 / x", only=LENGTHS)
def reciprocal(asked: Asked) -> np.ndarray:
    with np.errstate(divide="ignore"):
        return 1 / asked.truth


predict(
    "the right value less range_min",
    lambda asked: asked.truth - asked.scans.low if asked.scans else asked.unknown,
    LENGTHS,
)


@predicts("the part of all rays that is valid, not their number", only=(COUNT,))
def share(asked: Asked) -> np.ndarray:
    return asked.truth / np.array([len(row) for row in asked.scans.rows]) if asked.scans else asked.unknown


predict("the percentage of all rays that is valid, not their number", lambda asked: 100 * share(asked), (COUNT,))
predict("rounded up to whole numbers", lambda asked: np.ceil(asked.truth), LENGTHS)
predict("the square root of the right value", lambda asked: np.sqrt(asked.truth))
predict("the natural logarithm of the right value", lambda asked: np.log(asked.truth))
predict("whole centimetres; metres are asked for", lambda asked: np.floor(100 * asked.truth), LENGTHS)
predict("whole millimetres; metres are asked for", lambda asked: np.floor(1000 * asked.truth), LENGTHS)
predict("rounded up to one decimal", lambda asked: np.ceil(asked.truth * 10) / 10, LENGTHS)
predict(
    "range_max less the right value",
    lambda asked: asked.scans.high - asked.truth if asked.scans else asked.unknown,
    LENGTHS,
)
predict(
    "the right value divided by range_max",
    lambda asked: asked.truth / asked.scans.high if asked.scans else asked.unknown,
    LENGTHS,
)
predict(
    "the root mean square of the valid ranges",
    lambda asked: asked.of_valid(lambda valid: np.sqrt(np.mean(valid**2))),
    LENGTHS,
)
predict(
    "the average of the squares of the valid ranges",
    lambda asked: asked.of_valid(lambda valid: np.mean(valid**2)),
    LENGTHS,
)
predict(
    "the harmonic mean of the valid ranges, n / sum(1 / r)",
    lambda asked: asked.of_valid(lambda valid: len(valid) / np.sum(1 / valid)),
    LENGTHS,
)
predict(
    "the geometric mean of the valid ranges",
    lambda asked: asked.of_valid(lambda valid: np.exp(np.mean(np.log(valid)))),
    LENGTHS,
)
predict("the variance of the valid ranges", lambda asked: asked.of_valid(np.var), LENGTHS)
predict(
    "the difference between the largest and the smallest valid range",
    lambda asked: asked.of_valid(np.ptp),
    (*LENGTHS, COUNT),
)
predict(
    "the largest difference between two rays side by side",
    lambda asked: asked.of_valid(lambda valid: np.abs(np.diff(valid)).max()),
    LENGTHS,
)
predict(
    "the average of ranges that were cut to whole numbers first",
    lambda asked: asked.of_valid(lambda valid: np.floor(valid).mean()),
    (MEAN,),
)
predict(
    "the average of ranges that were rounded to whole numbers first",
    lambda asked: asked.of_valid(lambda valid: np.round(valid).mean()),
    (MEAN,),
)
predict(
    "the average without the smallest and the largest valid range",
    lambda asked: asked.of_valid(lambda valid: np.sort(valid)[1:-1].mean()),
    (MEAN,),
    rank=2,
)
predict(
    "the average of all pairs of rays side by side, half of each sum",
    lambda asked: asked.of_valid(lambda valid: float(np.mean((valid[1:] + valid[:-1]) / 2))),
    (MEAN,),
    rank=2,
)
predict(
    "the number of different values among the valid ranges",
    lambda asked: asked.of_valid(lambda valid: len(np.unique(valid))),
    (COUNT,),
)
