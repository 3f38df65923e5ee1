"""Reads `<camera>` (image size, field of view, lens, clip planes) and computes the ray of every pixel.

A camera looks along +x of its frame, with y to the left and z up; pixels run right (-y) and down (-z). Lens distortion
is Brown's model with k1 k2 p1 p2 k3 in OpenCV's notation.

Source: https://docs.opencv.org/4.x/d9/d0c/group__calib3d.html (camera model, distortion)
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.sdf.element import Element

Floats = NDArray[np.float64]

MOST_PIXELS = 8_300_000
"""A picture of 3840 x 2160 pixels."""
_UNDISTORT_ROUNDS = 20


class Pinhole:
    """The geometry of one camera: `width` x `height` pixels, focal lengths `fx fy` and principal point `cx cy` [px],
    clip planes `near` and `far` [m] along x.
    """

    WIDEST = 3.14
    """The largest horizontal field of view [rad]."""
    planar = True
    """True if `near` and `far` are planes, False if they are distances from the camera."""

    def __init__(self, camera: Element) -> None:
        """Read a `<camera>` element. Raises SdfError for impossible values."""
        image = camera.find("image") or Element("image", file=camera.file, line=camera.line)
        self.width, self.height = image.integer("width", 320), image.integer("height", 240)
        if self.width < 1 or self.height < 1 or self.width * self.height > MOST_PIXELS:
            raise image.error(
                f"an image needs 1 to {MOST_PIXELS} pixels, this one is {self.width} x {self.height}; "
                "change <width> and <height>"
            )
        self.hfov = camera.number("horizontal_fov", 1.047)
        if not 0.01 <= self.hfov <= self.WIDEST:
            text = f"<horizontal_fov> must be between 0.01 and {self.WIDEST:.3g} rad, got {self.hfov}"
            if self.WIDEST < self.hfov < 180.0:
                text += f"; {self.hfov:g} degrees are {math.radians(self.hfov):.4f} rad"
            raise (camera.find("horizontal_fov") or camera).error(text)
        clip = camera.find("clip")
        self.near = clip.number("near", 0.1) if clip is not None else 0.1
        self.far = clip.number("far", 100.0) if clip is not None else 100.0
        if not 0.0 < self.near < self.far < 1e9:
            raise (clip or camera).error(f"<clip> needs 0 < near < far, got near {self.near} and far {self.far}")
        self._read_lens(camera)
        distortion = camera.find("distortion")
        names = ("k1", "k2", "p1", "p2", "k3")
        self.distortion = (
            tuple(distortion.number(name, 0.0) for name in names) if distortion is not None else (0.0,) * 5
        )
        if not all(math.isfinite(value) and abs(value) < 1e3 for value in self.distortion):
            raise (distortion or camera).error(f"<distortion> must hold reasonable numbers, got {self.distortion}")

    def _read_lens(self, camera: Element) -> None:
        focal = self.width / (2.0 * math.tan(self.hfov / 2.0))
        self.fx = self.fy = focal
        self.cx, self.cy, self.skew = self.width / 2.0, self.height / 2.0, 0.0
        intrinsics = camera.find("lens/intrinsics")
        if intrinsics is not None:
            self.fx, self.fy = intrinsics.number("fx", focal), intrinsics.number("fy", focal)
            self.cx, self.cy = intrinsics.number("cx", self.cx), intrinsics.number("cy", self.cy)
            self.skew = intrinsics.number("s", 0.0)
        # `<projection>` always sets camera_info; it changes the image only if it is stated.
        projection = camera.find("lens/projection")
        self.projection = (self.fx, self.fy, self.cx, self.cy, 0.0, 0.0)
        if projection is not None:
            names = ("p_fx", "p_fy", "p_cx", "p_cy", "tx", "ty")
            self.projection = (
                projection.number(names[0], self.fx),
                projection.number(names[1], self.fy),
                projection.number(names[2], self.cx),
                projection.number(names[3], self.cy),
                projection.number(names[4], 0.0),
                projection.number(names[5], 0.0),
            )
        for value in (self.fx, self.fy, *self.projection[:2]):
            if not 1e-3 < value < 1e7:
                raise (projection or intrinsics or camera).error(f"a focal length must be positive, got {value}")
        for value in (self.cx, self.cy, self.skew, *self.projection[2:]):
            if not abs(value) < 1e7:
                raise (projection or intrinsics or camera).error(f"<lens> must hold reasonable numbers, got {value}")

    @property
    def distorted(self) -> bool:
        return any(self.distortion)

    def slopes(self) -> tuple[Floats, Floats]:
        """Return the slopes to the left (y/x) and up (z/x) of every pixel centre, (n,) each, in row-major order."""
        fx, fy, cx, cy = self.projection[:4]
        columns, rows = np.meshgrid(np.arange(self.width) + 0.5, np.arange(self.height) + 0.5)
        down = (rows.ravel() - cy) / fy
        right = (columns.ravel() - cx - self.skew * down) / fx
        if self.distorted:
            right, down = self._undistort(right, down)
        return -right, -down

    def _undistort(self, right: Floats, down: Floats) -> tuple[Floats, Floats]:
        """Return the undistorted image coordinates of distorted ones, by fixed-point iteration."""
        k1, k2, p1, p2, k3 = self.distortion
        x, y = right.copy(), down.copy()
        for _ in range(_UNDISTORT_ROUNDS):
            square = np.minimum(x * x + y * y, 25.0)
            radial = np.maximum(1.0 + square * (k1 + square * (k2 + square * k3)), 0.1)
            x, y = (
                (right - 2.0 * p1 * x * y - p2 * (square + 2.0 * x * x)) / radial,
                (down - p1 * (square + 2.0 * y * y) - 2.0 * p2 * x * y) / radial,
            )
        return x, y

    def directions(self) -> Floats:
        """Return the unit vector (n, 3) of every pixel in the camera's frame, row-major from the top left."""
        left, up = self.slopes()
        vectors = np.stack((np.ones_like(left), left, up), axis=1)
        return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)

    def fill_info(self, message: Any) -> None:
        """Write everything but the header of a CameraInfo."""
        message.width, message.height = self.width, self.height
        message.distortion.model = message.distortion.PLUMB_BOB
        message.distortion.k.extend(self.distortion)
        message.intrinsics.k.extend((self.fx, 0.0, self.cx, 0.0, self.fy, self.cy, 0.0, 0.0, 1.0))
        fx, fy, cx, cy, tx, ty = self.projection
        message.projection.p.extend((fx, 0.0, cx, tx, 0.0, fy, cy, ty, 0.0, 0.0, 1.0, 0.0))
        message.rectification_matrix.extend((1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0))
