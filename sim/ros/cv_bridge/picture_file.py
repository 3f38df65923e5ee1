"""Compressed pictures in memory, read and written with Pillow in the order of channels that OpenCV has (BGR).

Source: `imdecode` (IMREAD_ANYCOLOR) and `imencode` of OpenCV 4 with their default parameters
"""

from __future__ import annotations

import io
import warnings
from typing import Any

import numpy as np
from PIL import Image, ImageOps

from gz_course.sim.did_you_mean import did_you_mean

_JPEG: dict[str, Any] = {"quality": 95, "subsampling": "4:2:0"}
_FORMATS: dict[str, tuple[str, dict[str, Any]]] = {
    **{name: ("BMP", {}) for name in ("bmp", "dib")},
    **{name: ("JPEG", _JPEG) for name in ("jpg", "jpeg", "jpe")},
    "jp2": ("JPEG2000", {}),
    "png": ("PNG", {"compress_level": 1}),
    **{name: ("PPM", {}) for name in ("pbm", "pgm", "ppm")},
    **{name: ("TIFF", {"compression": "tiff_lzw"}) for name in ("tif", "tiff")},
    "webp": ("WEBP", {"lossless": True}),
}
_NO_ALPHA = ("BMP", "JPEG", "PPM")
_MAX_PIXELS = 1 << 27


def decoded(content: bytes) -> np.ndarray | None:
    """Return a picture as (height, width) if it is gray, else as (height, width, 3) in BGR, with 8 bits a value.

    The result is None if the content is no picture, or one of more than 2^27 pixels.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            with Image.open(io.BytesIO(content)) as picture:
                if picture.width * picture.height > _MAX_PIXELS:
                    return None
                turned = ImageOps.exif_transpose(picture)
                if turned.mode.startswith("I;16"):
                    return (np.asarray(turned) >> 8).astype(np.uint8)
                if turned.mode in ("1", "L", "LA"):
                    return np.array(turned.convert("L"))
                return np.ascontiguousarray(np.asarray(turned.convert("RGB"))[:, :, ::-1])
    except Exception:  # damaged content; Pillow raises many kinds of errors
        return None


def encoded(image: np.ndarray, name: str) -> bytes:
    """Return an image as the content of a file whose name ends with `name`. Raises RuntimeError if that is impossible.

    Values with more than 8 bits are limited to [0, 255], unless the format is PNG and the image gray with 16 bits.
    """
    if name not in _FORMATS:
        raise RuntimeError(f"there is no picture format '{name[:60]}'{did_you_mean(name, _FORMATS)}")
    pillow_name, options = _FORMATS[name]
    channels = 1 if image.ndim == 2 else image.shape[2] if image.ndim == 3 else 0
    if channels not in (1, 3, 4) or 0 in image.shape:
        raise RuntimeError(f"an image of shape {image.shape} has no picture; it needs 1, 3 or 4 channels and pixels")
    if channels == 1:
        image = image.reshape(image.shape[:2])
    if not (image.dtype == np.uint16 and channels == 1 and pillow_name in ("PNG", "TIFF")) and image.dtype != np.uint8:
        image = np.clip(np.rint(image), 0, 255).astype(np.uint8)
    if channels == 4:
        image = image[:, :, [2, 1, 0]] if pillow_name in _NO_ALPHA else image[:, :, [2, 1, 0, 3]]
    elif channels == 3:
        image = image[:, :, ::-1]
    out = io.BytesIO()
    try:
        Image.fromarray(np.ascontiguousarray(image)).save(out, pillow_name, **options)
    except (OSError, ValueError, KeyError) as error:
        raise RuntimeError(f"a picture of type {image.dtype} cannot be written as '{name}': {error}") from None
    return out.getvalue()
