"""Other averages and spreads of the valid ranges, and averages of ranges that were changed before."""

from __future__ import annotations

import numpy as np

from gz_course.grader.feedback.predictions.answers import COUNT, LENGTHS, MEAN, predict

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
