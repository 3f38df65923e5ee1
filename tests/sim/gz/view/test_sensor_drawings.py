"""Messages of sensors as drawings."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.msgs.image_pb2 import BGR_INT8, L_INT8, L_INT16, R_FLOAT32, RGB_INT8, RGB_INT16, Image
from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan
from gz_course.sim.gz.view.sensor_drawings import MOST_RAYS, pixels_of, rays_of


def test_rays_end_where_the_scan_hits() -> None:
    scan: Any = LaserScan(angle_min=-math.pi / 2, angle_step=math.pi / 2, range_min=0.1, range_max=10.0)
    scan.ranges.extend([2.0, 3.0, math.inf])
    scan.world_pose.position.x = 1.0
    scan.world_pose.orientation.w = scan.world_pose.orientation.z = math.sqrt(0.5)  # looks along y
    right, ahead = rays_of(scan)
    ends = sorted((np.round(2 * np.asarray(each.pos) - (1.0, 0.0, 0.0), 3)).tolist() for each in (right, ahead))
    assert ends == [[1.0, 3.0, 0.0], [3.0, 0.0, 0.0]], "a capsule lies around its middle"


@settings(max_examples=25)
@given(st.lists(st.floats(0.0, 20.0) | st.just(math.inf) | st.just(math.nan), max_size=600), st.integers(0, 4))
def test_any_scan_is_drawn(ranges: list[float], rows: int) -> None:
    scan: Any = LaserScan(angle_step=0.01, range_min=0.1, range_max=10.0, vertical_count=rows)
    scan.ranges.extend(ranges)
    rays = rays_of(scan)
    assert len(rays) <= MOST_RAYS
    assert all(np.isfinite(each.pos).all() and np.isfinite(each.size).all() for each in rays)


@pytest.mark.parametrize(
    ("kind", "data", "expected"),
    [
        (RGB_INT8, bytes([1, 2, 3, 4, 5, 6]), [[1, 2, 3], [4, 5, 6]]),
        (BGR_INT8, bytes([1, 2, 3, 4, 5, 6]), [[3, 2, 1], [6, 5, 4]]),
        (L_INT8, bytes([7, 9]), [[7, 7, 7], [9, 9, 9]]),
        (L_INT16, np.array([0, 1000], "<u2").tobytes(), [[0, 0, 0], [255, 255, 255]]),
        (R_FLOAT32, np.array([np.inf, 4.0], "<f4").tobytes(), [[0, 0, 0], [255, 255, 255]]),
        (RGB_INT16, bytes(12), None),
        (RGB_INT8, bytes(5), None),
    ],
)
def test_a_picture_is_shown_as_rgb(kind: int, data: bytes, expected: list[list[int]] | None) -> None:
    pixels = pixels_of(Image(width=2, height=1, pixel_format_type=kind, data=data))
    assert (None if pixels is None else pixels[0].tolist()) == expected
