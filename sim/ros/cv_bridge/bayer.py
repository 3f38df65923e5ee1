"""Colors from the raw image of a sensor with a Bayer pattern: the mean of the nearest pixels of each color.

Pixels at the border get the colors of their neighbours inside.

Source: imgproc/src/demosaicing.cpp of OpenCV 4 (COLOR_BayerBG2BGR and relatives; OpenCV names a pattern by its second
row, ROS by its first)
"""

from __future__ import annotations

import numpy as np

_WEIGHTS = {"r": 4899, "g": 9617, "b": 1868}  # 0.299, 0.587, 0.114 in units of 2^-14
_SHIFT = 14


def demosaic(image: np.ndarray, pattern: str, layout: str) -> np.ndarray:
    """Return an image with the channels of `layout` (`rgb` or `bgr`); `pattern` begins at the upper left corner.

    An image that is 2 pixels wide or high, or less, becomes black, as in OpenCV.
    """
    out = np.zeros((*image.shape, 3), image.dtype)
    if min(image.shape) < 3:
        return out
    means = _means(image)
    for row in (0, 1):
        for column in (0, 1):
            here = (slice(row, None, 2), slice(column, None, 2))
            own = _color(pattern, row + 1, column + 1)  # of the pixel in the middle of 3x3
            for place, color in enumerate(layout):
                total, shift = means[_how(pattern, own, color, row + 1)]
                out[1:-1, 1:-1, place][here] = (total[here] + ((1 << shift) >> 1)) >> shift
    return _with_border(out)


def demosaic_gray(image: np.ndarray, pattern: str) -> np.ndarray:
    """Return the brightness, from the means of the colors before they are rounded."""
    out = np.zeros(image.shape, image.dtype)
    if min(image.shape) < 3:
        return out
    means = _means(image)
    for row in (0, 1):
        for column in (0, 1):
            here = (slice(row, None, 2), slice(column, None, 2))
            own = _color(pattern, row + 1, column + 1)
            ways = [(weight, *means[_how(pattern, own, color, row + 1)]) for color, weight in _WEIGHTS.items()]
            most = max(shift for _, _, shift in ways)
            total = sum((weight << (most - shift)) * sums[here] for weight, sums, shift in ways)
            out[1:-1, 1:-1][here] = (total + (1 << (most + _SHIFT - 1))) >> (most + _SHIFT)
    return _with_border(out)


def _means(image: np.ndarray) -> dict[str, tuple[np.ndarray, int]]:
    """Return sums of pixels around each inner pixel, and the power of two that says of how many."""
    wide = image.astype(np.uint32)
    level = wide[1:-1, :-2] + wide[1:-1, 2:]
    upright = wide[:-2, 1:-1] + wide[2:, 1:-1]
    diagonal = wide[:-2, :-2] + wide[:-2, 2:] + wide[2:, :-2] + wide[2:, 2:]
    return {
        "itself": (wide[1:-1, 1:-1], 0),
        "level": (level, 1),
        "upright": (upright, 1),
        "cross": (level + upright, 2),
        "diagonal": (diagonal, 2),
    }


def _color(pattern: str, row: int, column: int) -> str:
    return pattern[2 * (row % 2) + column % 2]


def _how(pattern: str, own: str, color: str, row: int) -> str:
    """Return which pixels around one of the color `own`, in a row, have the wanted color."""
    if own == color:
        return "itself"
    if own != "g":
        return "cross" if color == "g" else "diagonal"
    return "level" if color in (_color(pattern, row, 0), _color(pattern, row, 1)) else "upright"


def _with_border(out: np.ndarray) -> np.ndarray:
    out[:, 0], out[:, -1] = out[:, 1], out[:, -2]
    out[0], out[-1] = out[1], out[-2]
    return out
