"""Lengths and directions of vectors, also of many along an axis of an array.

Source: https://github.com/DLu/tf_transformations
"""

from __future__ import annotations

from typing import Any

import numpy as np


def vector_norm(data: Any, axis: int | None = None, out: Any = None) -> Any:
    """Return the length of a vector, or an array of the lengths along an axis, which is also written to `out`."""
    array = np.asarray(data, dtype=np.float64)
    lengths = np.sqrt(np.sum(array * array, axis=axis))
    if out is not None:
        out[...] = lengths
        return None
    return float(lengths) if array.ndim <= 1 else np.atleast_1d(lengths)


def unit_vector(data: Any, axis: int | None = None, out: Any = None) -> Any:
    """Return a vector divided by its length; arrays along an axis; or write it to `out`."""
    array = np.array(data, dtype=np.float64)
    length = np.sqrt(np.sum(array * array, axis=axis, keepdims=axis is not None))
    array /= length
    if out is None:
        return array
    out[...] = array
    return None


def random_vector(size: int) -> Any:
    """Return random numbers from 0 to 1."""
    return np.random.random(size)
