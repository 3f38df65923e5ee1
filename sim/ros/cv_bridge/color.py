"""Conversions between encodings, with the arithmetic of OpenCV, value for value.

Source: `getConversionCode` and `toCvCopyImpl` in cv_bridge/src/cv_bridge.cpp of vision_opencv 4.1, the texts of its
exceptions included; `cvtColor` and `convertTo` of OpenCV 4 (imgproc/src/color_rgb.simd.hpp, color_yuv.simd.hpp,
core/src/convert_scale.simd.hpp); ITU-R BT.601
"""

from __future__ import annotations

import numpy as np

from gz_course.sim.ros.cv_bridge.bayer import demosaic, demosaic_gray
from gz_course.sim.ros.cv_bridge.encodings import (
    COLOR_FORMATS,
    NUMPY_NAMES,
    bits,
    channel_count,
    cv_type,
    depth_of,
)

_GRAY_WEIGHTS = {"r": 9798, "g": 19235, "b": 3735}  # 0.299, 0.587, 0.114 in units of 2^-15
_GRAY_SHIFT = 15
# BT.601 in units of 2^-20: brightness, then what U and V add to red, green and blue.
_Y, _V_RED, _U_GREEN, _V_GREEN, _U_BLUE, _YUV_SHIFT = 1220542, 1673527, -409993, -852492, 2116026, 20
_INT_MIN = -(2**31)


def convert(image: np.ndarray, source: str, target: str) -> np.ndarray:
    """Return a new array with the image in another encoding; with one channel it is (height, width).

    Raises RuntimeError if there is no such conversion.
    """
    if target in ("", source):
        return np.array(image, order="C")
    check(source, target)
    depth = NUMPY_NAMES[depth_of(cv_type(target))]
    from_format, to_format = COLOR_FORMATS.get(source), COLOR_FORMATS.get(target)
    if from_format is None or to_format is None or from_format.layout == to_format.layout:
        return _one_channel_flat(_scaled(image, depth, bits(source), bits(target)))
    if from_format.channels != (1 if image.ndim == 2 else image.shape[2]):
        seen = "one channel" if image.ndim == 2 else f"{image.shape[2]} channels"
        raise RuntimeError(f"the image has {seen}, but [{source}] has {from_format.channels}")
    colors = _colors(image, from_format.layout, to_format.layout)
    if bits(source) != bits(target):
        colors = _scaled(colors, depth, bits(source), bits(target))
    return _one_channel_flat(colors)


def check(source: str, target: str) -> None:
    """Raise RuntimeError if there is no conversion between two encodings that differ."""
    same_count = channel_count(source) == channel_count(target)
    if source not in COLOR_FORMATS and target in COLOR_FORMATS:
        raise RuntimeError(f"[{source}] is not a color format. but [{target}] is. The conversion does not make sense")
    if source not in COLOR_FORMATS or target not in COLOR_FORMATS:
        if same_count:
            return
        if source not in COLOR_FORMATS:
            raise RuntimeError(f"[{source}] and [{target}] do not have the same number of channel")
        raise RuntimeError(
            f"[{source}] is a color format but [{target}] is not so they must have the same OpenCV type, "
            "CV_8UC3, CV16UC1 ...."
        )
    start, end = COLOR_FORMATS[source].layout, COLOR_FORMATS[target].layout
    raw = end.startswith("bayer") or (end in ("uyvy", "yuyv") and start != end)
    if raw or (start.startswith("bayer") and end.endswith("a")):
        raise RuntimeError(f"Unsupported conversion from [{source}] to [{target}]")


def _one_channel_flat(image: np.ndarray) -> np.ndarray:
    return image[:, :, 0] if image.ndim == 3 and image.shape[2] == 1 else image


def _colors(image: np.ndarray, start: str, end: str) -> np.ndarray:
    """Return the image with the channels of the layout `end`, in the type it has."""
    if start.startswith("bayer_"):
        pattern = start.removeprefix("bayer_")
        return demosaic_gray(image, pattern) if end == "gray" else demosaic(image, pattern, end)
    if start in ("uyvy", "yuyv"):
        return _from_yuv(image, start, end)
    if end == "gray":
        exact = np.dtype("f4" if image.itemsize == 1 else "f8")  # holds the sums without rounding
        weights = np.array([_GRAY_WEIGHTS.get(color, 0) for color in start], exact)
        total = np.matmul(image.astype(exact), weights).astype(np.uint32)
        return ((total + (1 << (_GRAY_SHIFT - 1))) >> _GRAY_SHIFT).astype(image.dtype)
    out = np.empty((*image.shape[:2], len(end)), image.dtype)
    for place, color in enumerate(end):
        if color == "a" and not start.endswith("a"):
            out[:, :, place] = np.iinfo(image.dtype).max
        else:
            out[:, :, place] = image if start == "gray" else image[:, :, start.index(color)]
    return out


def _from_yuv(image: np.ndarray, start: str, end: str) -> np.ndarray:
    """Return a 4:2:2 image in another layout; two pixels share U and V, in the order of `start`."""
    height, width = image.shape[:2]
    if width % 2:
        raise RuntimeError(f"an image in YUV 4:2:2 has an even width, not {width}")
    brightness = image[:, :, start.index("y") % 2]
    if end == "gray":
        return brightness.copy()
    pairs = image.reshape(height, width // 2, 4)
    u, v = (pairs[:, :, start.index(letter)].astype(np.int64) - 128 for letter in "uv")
    half = 1 << (_YUV_SHIFT - 1)
    added = {"r": _V_RED * v + half, "g": _V_GREEN * v + _U_GREEN * u + half, "b": _U_BLUE * u + half}
    y = np.maximum(brightness.astype(np.int64) - 16, 0) * _Y
    out = np.full((height, width, len(end)), 255, np.uint8)
    for place, color in enumerate(end):
        if color != "a":
            out[:, :, place] = np.clip((y + np.repeat(added[color], 2, axis=1)) >> _YUV_SHIFT, 0, 255)
    return out


def _scaled(image: np.ndarray, name: str, from_bits: int, to_bits: int) -> np.ndarray:
    """Return the image with values of another type: [0, 255] and [0, 65535] are scaled, others rounded and limited."""
    target = np.dtype(name)
    if (from_bits, to_bits) == (8, 16):
        return _limited(image.astype(np.int64) * 257, target)
    if (from_bits, to_bits) == (16, 8):
        return _limited(np.rint(image * (255.0 / 65535.0)).astype(np.int64), target)
    if target.kind == "f":
        with np.errstate(over="ignore"):
            return image.astype(target)
    if image.dtype.kind != "f":
        return _limited(image, target)
    with np.errstate(invalid="ignore"):
        rounded = np.rint(image.astype(np.float64))
        fits = (rounded >= _INT_MIN) & (rounded < -float(_INT_MIN))
    return _limited(np.where(fits, rounded, _INT_MIN).astype(np.int64), target)


def _limited(values: np.ndarray, target: np.dtype) -> np.ndarray:
    limits = np.iinfo(target)
    lowest, highest = np.iinfo(values.dtype).min, np.iinfo(values.dtype).max
    return np.clip(values, max(limits.min, lowest), min(limits.max, highest)).astype(target)
