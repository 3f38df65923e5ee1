"""Reads PNG files as grey values, such as the heights of a terrain. MuJoCo decodes them."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.errors import ResourceError

MOST_PIXELS = 4_200_000


def read_image(path: Path) -> NDArray[np.uint8]:
    """Return the first channel of a PNG file, (rows, columns) of 0..255. Raises ResourceError if it cannot be read."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ResourceError(f"the image {path} cannot be read ({error.strerror})") from None
    if not data.startswith(b"\x89PNG\r\n\x1a\n") or len(data) < 33:
        raise ResourceError(f"the image {path} is not a PNG file; convert it to one")
    width, height = (int.from_bytes(data[at : at + 4], "big") for at in (16, 20))
    if width < 2 or height < 2 or width * height > MOST_PIXELS:
        raise ResourceError(f"the image {path} has {width} x {height} pixels; 2 x 2 to 2049 x 2049 are possible")
    spec = mujoco.MjSpec()
    spec.assets = {"image.png": data}
    spec.add_texture(name="image", type=mujoco.mjtTexture.mjTEXTURE_2D, file="image.png", nchannel=1)
    try:
        model = spec.compile()
    except (ValueError, mujoco.FatalError) as error:
        raise ResourceError(f"the image {path} cannot be decoded ({' '.join(str(error).split())})") from None
    return np.array(model.tex_data[: width * height], dtype=np.uint8).reshape(height, width)
