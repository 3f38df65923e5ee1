"""What the encoding of an image means: the type of its values, its channels and their order.

Source: sensor_msgs/image_encodings.hpp; `getCvType` in cv_bridge/src/cv_bridge.cpp of vision_opencv 4.1, the texts of
its exceptions included; `CV_MAKETYPE` of OpenCV 4
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from gz_course.sim.did_you_mean import did_you_mean

DEPTHS = ("8U", "8S", "16U", "16S", "32S", "32F", "64F")
"""OpenCV's names of the types of values; the place of a name is its number."""
NUMPY_NAMES = ("uint8", "int8", "uint16", "int16", "int32", "float32", "float64")
_CHANNEL_SHIFT = 3
_MOST_CHANNELS = 512
_GENERIC = re.compile(r"(8U|8S|16U|16S|32S|32F|64F)(?:C([0-9]+))?", re.ASCII)
_COUNTED = re.compile(r"(8|16|32|64)([USF])C([0-9]*)", re.ASCII)


@dataclass(frozen=True)
class ColorFormat:
    """An encoding whose channels have a meaning: `layout` is an order of channels, or the name of a raw format."""

    layout: str
    depth: str
    channels: int


def _color_formats() -> dict[str, ColorFormat]:
    found = {}
    for bits in (8, 16):
        depth = f"{bits}U"
        found[f"mono{bits}"] = ColorFormat("gray", depth, 1)
        for layout in ("rgb", "bgr", "rgba", "bgra"):
            found[f"{layout}{bits}"] = ColorFormat(layout, depth, len(layout))
        for pattern in ("rggb", "bggr", "gbrg", "grbg"):
            found[f"bayer_{pattern}{bits}"] = ColorFormat(f"bayer_{pattern}", depth, 1)
    for name, layout in (("yuv422", "uyvy"), ("uyvy", "uyvy"), ("yuv422_yuy2", "yuyv"), ("yuyv", "yuyv")):
        found[name] = ColorFormat(layout, "8U", 2)
    return found


COLOR_FORMATS = _color_formats()


def cv_type(encoding: str) -> int:
    """Return OpenCV's number of the type. Raises RuntimeError for an unknown encoding."""
    if (known := COLOR_FORMATS.get(encoding)) is not None:
        return make_type(known.depth, known.channels)
    match = _GENERIC.fullmatch(encoding)
    channels = int(match[2] or 1) if match and len(match[2] or "") < 4 else 0
    if match is None or not 1 <= channels <= _MOST_CHANNELS:
        known_names = [*COLOR_FORMATS, *(f"{depth}C{n}" for depth in DEPTHS for n in (1, 2, 3, 4))]
        hint = did_you_mean(encoding, known_names)
        raise RuntimeError(f"Unrecognized image encoding [{encoding[:100]}]{hint}")
    return make_type(match[1], channels)


def make_type(depth: str, channels: int) -> int:
    """Return OpenCV's number of a type."""
    return DEPTHS.index(depth) + ((channels - 1) << _CHANNEL_SHIFT)


def channels_of(number: int) -> int:
    """Return the number of channels of a type."""
    return ((number >> _CHANNEL_SHIFT) & (_MOST_CHANNELS - 1)) + 1


def depth_of(number: int) -> int:
    """Return the number of the depth of a type."""
    return number & ((1 << _CHANNEL_SHIFT) - 1)


def channel_count(encoding: str) -> int:
    """Return the number of channels. Raises RuntimeError for an unknown encoding."""
    if (known := COLOR_FORMATS.get(encoding)) is not None:
        return known.channels
    return int(_generic(encoding)[3] or 1)


def bits(encoding: str) -> int:
    """Return the number of bits of a value. Raises RuntimeError for an unknown encoding."""
    if (known := COLOR_FORMATS.get(encoding)) is not None:
        return int(known.depth[:-1])
    return int(_generic(encoding)[1])


def _generic(encoding: str) -> re.Match[str]:
    match = _COUNTED.fullmatch(encoding)
    if match is None:
        raise RuntimeError(f"Unknown encoding {encoding[:100]}{did_you_mean(encoding, COLOR_FORMATS)}")
    return match
