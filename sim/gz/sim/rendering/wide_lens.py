"""The lens of a wide angle camera: where a ray at an angle to the optical axis meets the image.

A ray at the angle theta [rad] is r = c1 f fun(theta / c2 + c3) from the middle of the image, in half widths of it.
`<type>` is gnomonical, stereographic (the default), equidistant, equisolid_angle, orthographic or custom, with its
`<custom_function>`. With `<scale_to_hfov>` (the default) f is such that the field of view fills the width. Beyond
`<cutoff_angle>` the image is black.

Source: https://github.com/gazebosim/gz-rendering/blob/gz-rendering8/src/CameraLens.cc;
http://sdformat.org/spec?elem=sensor
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.rendering.pinhole import Pinhole
from gz_course.sim.gz.sim.rendering.viewpoint import Floats
from gz_course.sim.gz.sim.sdf.element import Element


class _Mapping(NamedTuple):
    c1: float
    c2: float
    c3: float
    f: float
    fun: str


_MAPPINGS = {
    "gnomonical": _Mapping(1.0, 1.0, 0.0, 1.0, "tan"),
    "gnomonic": _Mapping(1.0, 1.0, 0.0, 1.0, "tan"),
    "stereographic": _Mapping(2.0, 2.0, 0.0, 1.0, "tan"),
    "equidistant": _Mapping(1.0, 1.0, 0.0, 1.0, "id"),
    "equisolid_angle": _Mapping(2.0, 2.0, 0.0, 1.0, "sin"),
    "orthographic": _Mapping(1.0, 1.0, 0.0, 1.0, "sin"),
}
_FUNCTIONS: dict[str, tuple[Callable[[float], float], Callable[[Floats], Floats]]] = {
    "tan": (math.tan, np.arctan),
    "sin": (math.sin, lambda r: np.where(np.abs(r) <= 1.0, np.arcsin(np.clip(r, -1.0, 1.0)), np.inf)),
    "id": (float, np.array),
}


class WideLens(Pinhole):
    """The geometry of a wide angle camera; near and far [m] are distances from the camera."""

    WIDEST = 2.0 * math.pi
    planar = False

    def _read_lens(self, camera: Element) -> None:
        # The focal length of camera_info is that of a pinhole, as in Gazebo, as long as there is one.
        wide = self.hfov >= 3.0
        self.fx = self.fy = self.width / (self.hfov if wide else 2.0 * math.tan(self.hfov / 2.0))
        self.cx, self.cy, self.skew = self.width / 2.0, self.height / 2.0, 0.0
        self.projection = (self.fx, self.fy, self.cx, self.cy, 0.0, 0.0)
        lens = camera.find("lens") or Element("lens", file=camera.file, line=camera.line)
        kind = lens.text_of("type", "stereographic")
        if kind not in (*_MAPPINGS, "custom"):
            hint = did_you_mean(kind, (*_MAPPINGS, "custom"), listing="known names are")
            raise lens.error(f"<type> of <lens> '{kind}' is not known{hint}")
        mapping = _custom(lens) if kind == "custom" else _MAPPINGS[kind]
        if lens.flag("scale_to_hfov", True):
            edge = mapping.c1 * _FUNCTIONS[mapping.fun][0](self.hfov / 2.0 / mapping.c2 + mapping.c3)
            if not 1e-9 < edge < 1e9:
                text = f"a {kind} lens cannot show a <horizontal_fov> of {self.hfov:g} rad"
                raise lens.error(f"{text}; make it smaller, or take another <type>")
            mapping = mapping._replace(f=1.0 / edge)
        self._mapping = mapping
        self.cutoff = lens.number("cutoff_angle", math.pi / 2.0)
        """The largest angle [rad] to the optical axis."""

    def directions(self) -> Floats:
        """Return the unit vector (n, 3) of every pixel; that of a black one points ahead."""
        right, down, angle = self._rays()
        seen = self._seen(angle)
        radius = np.maximum(np.hypot(right, down), 1e-12)
        angle = np.where(seen, angle, 0.0)
        across = np.sin(angle) / radius
        return np.stack((np.cos(angle), -across * right, -across * down), axis=1)

    def black(self) -> NDArray[np.bool_]:
        """Return which pixels (n,) lie beyond the cut-off angle."""
        return ~self._seen(self._rays()[2])

    def _seen(self, angle: Floats) -> NDArray[np.bool_]:
        return (angle >= 0.0) & (angle <= min(self.cutoff, math.pi))

    def _rays(self) -> tuple[Floats, Floats, Floats]:
        """Return the place of each pixel right of and below the middle, in half widths, and its angle [rad]."""
        half = self.width / 2.0
        columns, rows = np.meshgrid(np.arange(self.width) + 0.5, np.arange(self.height) + 0.5)
        right, down = (columns.ravel() - half) / half, (rows.ravel() - self.height / 2.0) / half
        c1, c2, c3, f, fun = self._mapping
        return right, down, (_FUNCTIONS[fun][1](np.hypot(right, down) / (c1 * f)) - c3) * c2


def _custom(lens: Element) -> _Mapping:
    function = lens.find("custom_function")
    if function is None:
        raise lens.error("a custom <lens> needs a <custom_function>, none was found")
    numbers = [function.number(name, default) for name, default in (("c1", 1.0), ("c2", 1.0), ("c3", 0.0), ("f", 1.0))]
    fun = function.text_of("fun", "tan")
    if fun not in _FUNCTIONS:
        hint = did_you_mean(fun, _FUNCTIONS, listing="known names are")
        raise function.error(f"<fun> '{fun}' is not known{hint}")
    if not all(map(math.isfinite, numbers)) or 0.0 in (numbers[0], numbers[1], numbers[3]):
        raise function.error("<c1>, <c2> and <f> of <custom_function> must be finite and not zero")
    return _Mapping(numbers[0], numbers[1], numbers[2], numbers[3], fun)
