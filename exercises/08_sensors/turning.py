"""What was subtracted as the bias of the gyroscope; `misconceptions.py` hands it on."""

import math

import numpy as np

STAND = 0.9  # [s] of the first second
FULL_TURN = 2 * math.pi  # [rad]


def other_bias(times, rates, turning, bias):
    """Return what was subtracted as the bias [rad/s] if the sum of `rates` was then a full turn; empty if unknown.

    `turning` says at which of the `times` [s] the robot truly turned.
    """
    first = times <= times[0] + STAND
    if first.sum() < 5 or not turning.any():
        return ""
    spans = np.diff(times, prepend=times[:1])
    after = ~first
    seconds = float(spans[after].sum())
    subtracted = (float((rates * spans)[after].sum()) - FULL_TURN) / seconds
    standing = rates[first]
    near = 0.03 / seconds + 0.1 * float(np.abs(rates).max()) / seconds  # what a late number, and the last 0.1 s, change
    mean = float(standing.mean())
    if abs(subtracted - mean) <= near:
        return ""
    fitting = [
        words
        for words, value in (
            ("the standard deviation of the rates, their noise", float(standing.std())),
            ("the largest of the rates", float(standing.max())),
            ("the smallest of the rates", float(standing.min())),
            ("half of the mean", mean / 2),
            ("twice the mean", 2 * mean),
        )
        if abs(subtracted - value) <= near
    ]
    is_it = f", which is {fitting[0]} while the robot stands" if len(fitting) == 1 else ""
    if abs(subtracted) > 3 * abs(bias) + 0.05:
        return ""
    return (
        f"the bias that you subtract is wrong: by your heading it is about {subtracted:.3f} rad/s{is_it}; the mean of "
        f"the rates while the robot stands is {mean:.3f} rad/s"
    )
