"""Conversions have the values of OpenCV, which were written down from it, and follow their formulas pixel by pixel."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from gz_course.sim.ros.cv_bridge.color import convert

RGB = np.array([[[255, 0, 0], [0, 255, 0], [0, 0, 255], [12, 200, 77]]], np.uint8)
DEEP = np.array([[[65535, 0, 0], [0, 65535, 0], [0, 0, 65535], [1234, 54321, 777]]], np.uint16)
YUV = np.array([[[90, 81], [240, 145], [128, 16], [128, 235], [10, 200], [250, 3]]], np.uint8)
BAYER = (np.arange(20).reshape(4, 5) * 37 % 251).astype(np.uint8)
FLOATS = np.array([[-1.5, 0.5, 1.5, 2.5, 254.5, 300, 1e12, np.nan]], np.float32)


@pytest.mark.parametrize(
    ("image", "source", "target", "expected"),
    [
        (RGB, "rgb8", "mono8", [[76, 150, 29, 130]]),
        (RGB[:, :, ::-1], "bgr8", "mono8", [[76, 150, 29, 130]]),
        (DEEP, "rgb16", "mono16", [[19596, 38469, 7470, 32344]]),
        (RGB[:, 3:], "rgb8", "bgra8", [[[77, 200, 12, 255]]]),
        (RGB[:, 3:], "rgb8", "bgr16", [[[77 * 257, 200 * 257, 12 * 257]]]),
        (DEEP[:, 3:], "rgb16", "rgba16", [[[1234, 54321, 777, 65535]]]),
        (DEEP[:, 3:], "rgb16", "rgba8", [[[5, 211, 3, 255]]]),
        (np.array([[9]], np.uint8), "mono8", "rgba8", [[[9, 9, 9, 255]]]),
        (np.array([[9]], np.uint8), "mono8", "mono16", [[2313]]),
        (np.array([[9]], np.uint8), "mono8", "16UC1", [[2313]]),
        (np.array([[128, 129, 65535]], np.uint16), "16UC1", "8UC1", [[0, 1, 255]]),
        (np.array([[-5, 70000]], np.int32), "32SC1", "16UC1", [[0, 65535]]),
        (FLOATS, "32FC1", "8UC1", [[0, 0, 2, 2, 254, 255, 0, 0]]),
        (FLOATS, "32FC1", "16SC1", [[-2, 0, 2, 2, 254, 300, -32768, -32768]]),
        (FLOATS, "32FC1", "32SC1", [[-2, 0, 2, 2, 254, 300, -(2**31), -(2**31)]]),
        (YUV, "yuv422", "mono8", [[81, 145, 16, 235, 200, 3]]),
        (YUV[:, :2], "yuv422", "rgb8", [[[254, 0, 0], [255, 74, 73]]]),
        (YUV[:, 4:], "uyvy", "bgr8", [[[0, 161, 255], [0, 0, 195]]]),
        (YUV[:, :2], "yuv422_yuy2", "rgb8", [[[113, 91, 0], [255, 255, 166]]]),
        (YUV[:, 4:], "yuyv", "rgba8", [[[0, 73, 145, 255], [73, 255, 255, 255]]]),
        (BAYER[:3, :3], "bayer_rggb8", "rgb8", [[[97, 97, 222]] * 3] * 3),
        (BAYER[:3, :3], "bayer_bggr8", "bgr8", [[[97, 97, 222]] * 3] * 3),
        (BAYER[:3], "bayer_gbrg8", "rgb8", [[[97, 222, 97]] * 2 + [[8, 134, 134]] + [[45, 45, 171]] * 2] * 3),
        (BAYER[:3], "bayer_grbg8", "bgr8", [[[97, 222, 97]] * 2 + [[8, 134, 134]] + [[45, 45, 171]] * 2] * 3),
        (BAYER[:3], "bayer_rggb8", "mono8", [[111, 111, 60, 101, 101]] * 3),
        (BAYER[:3], "bayer_grbg8", "mono8", [[170, 170, 119, 83, 83]] * 3),
        (BAYER[:2], "bayer_rggb8", "mono8", [[0] * 5] * 2),
    ],
)
def test_values_of_opencv(image, source, target, expected):
    assert convert(image, source, target).tolist() == expected


@given(arrays.arrays(np.uint8, st.tuples(st.integers(1, 6), st.integers(1, 6), st.just(4))))
def test_channels_only_change_places(image):
    orders = ["rgba", "bgra", "rgb", "bgr"]
    for start in orders:
        for end in orders:
            own = image[:, :, : len(start)]
            out = convert(own, f"{start}8", f"{end}8")
            for place, color in enumerate(end):
                wanted = own[:, :, start.index(color)] if color in start else np.full(own.shape[:2], 255)
                assert (out[:, :, place] == wanted).all()
            assert not np.shares_memory(out, image)


@given(arrays.arrays(np.uint16, (3, 4, 3)))
def test_gray_is_the_weighted_mean(image):
    gray = convert(image, "rgb16", "mono16")
    for y in range(3):
        for x in range(4):
            red, green, blue = (int(value) for value in image[y, x])
            exact = Fraction(299 * red + 587 * green + 114 * blue, 1000)
            assert abs(int(gray[y, x]) - exact) <= 2


@given(arrays.arrays(np.uint8, (4, 6, 3)), st.sampled_from(["rggb", "bggr", "gbrg", "grbg"]))
def test_an_even_picture_survives_its_bayer_pattern(image, pattern):
    """What a sensor with a Bayer pattern sees of one color is that color again."""
    color = image[0, 0]
    raw = np.empty((4, 6), np.uint8)
    for y in range(4):
        for x in range(6):
            raw[y, x] = color["rgb".index(pattern[2 * (y % 2) + x % 2])]
    assert (convert(raw, f"bayer_{pattern}8", "rgb8") == color).all()
    gray = convert(raw, f"bayer_{pattern}8", "mono8").astype(int)
    assert abs(gray - int(convert(color[None, None], "rgb8", "mono8")[0, 0])).max() <= 1


def test_scaling_is_exact_for_every_value():
    deep = np.arange(65536, dtype=np.uint16)[None]
    assert (convert(deep, "mono16", "mono8")[0] == [(value + 128) // 257 for value in range(65536)]).all()
