"""Reads the images of materials: PNG and JPEG as arrays of colours, with limits.

An image is never decoded before its size is known: one with too many pixels is refused, and a large one is reduced.

Source: https://pillow.readthedocs.io/en/stable/reference/Image.html
"""

from __future__ import annotations

import hashlib
import io
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import ResourceError

Pixels = NDArray[np.uint8]
"""Colours (rows, columns, 3); the first row is the upper edge. Read-only."""

LARGEST = 1024
"""The longest side of a texture in memory [px]; larger images are reduced to it."""
_MOST_PIXELS = 36_000_000
_MOST_BYTES = 64 << 20
_FORMATS = ("PNG", "JPEG")
_ENDINGS = (".png", ".jpg", ".jpeg")


def read_texture(path: Path) -> Pixels:
    """Return the colours of a PNG or JPEG file. Raises `ResourceError` if it cannot be read or is too large."""
    try:
        stat = path.stat()
        if not path.is_file():
            raise ResourceError(f"the texture {path} is not a file")
    except OSError as error:
        hint = ""
        if path.parent.is_dir():
            images = [each.name for each in path.parent.iterdir() if each.suffix.lower() in _ENDINGS]
            hint = did_you_mean(path.name, images, listing="images in that folder are")
        raise ResourceError(f"the texture {path} cannot be read ({error.strerror}){hint}") from None
    if stat.st_size > _MOST_BYTES:
        raise ResourceError(f"the texture {path} has {stat.st_size >> 20} MiB, {_MOST_BYTES >> 20} are read")
    return _decoded(path, (stat.st_mtime_ns, stat.st_size))


@lru_cache(maxsize=64)
def _decoded(path: Path, _stamp: tuple[int, int]) -> Pixels:
    try:
        return decode(path.read_bytes(), str(path))
    except OSError as error:
        raise ResourceError(f"the texture {path} cannot be read ({error.strerror or error})") from None


def fingerprint(pixels: Pixels) -> bytes:
    """Return a digest of an image; images that look alike are kept once."""
    return hashlib.sha256(repr(pixels.shape).encode() + pixels.tobytes()).digest()


def decode(data: bytes, name: str) -> Pixels:
    """Return the colours of the bytes of an image file called `name`. Raises `ResourceError`."""
    from PIL import Image

    try:
        with Image.open(io.BytesIO(data), formats=_FORMATS) as image:
            width, height = image.size
            if width * height > _MOST_PIXELS:
                raise ResourceError(f"the texture {name} has {width} x {height} pixels; {_MOST_PIXELS} are read")
            image.draft("RGB", (LARGEST, LARGEST))
            colours = image.convert("RGB")
            if max(colours.size) > LARGEST:
                colours.thumbnail((LARGEST, LARGEST), Image.Resampling.BOX)
            pixels = np.array(colours, dtype=np.uint8)
    except ResourceError:
        raise
    except Exception as error:  # damaged files make Pillow's decoders raise errors of many kinds
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise ResourceError(f"the texture {name} is not a readable PNG or JPEG file ({reason})") from None
    pixels.flags.writeable = False
    return pixels
