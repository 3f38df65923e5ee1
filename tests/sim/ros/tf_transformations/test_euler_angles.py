"""Euler angles of all sequences of axes, and numbers that the field's documentation gives."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from gz_course.sim.ros.tf_transformations import (
    euler_from_matrix,
    euler_from_quaternion,
    euler_matrix,
    quaternion_from_euler,
    quaternion_from_matrix,
    quaternion_multiply,
    rotation_matrix,
)

AXES = [
    kind + "".join(axes) for kind in "sr" for axes in itertools.product("xyz", repeat=3) if axes[1] not in axes[::2]
]
angles = st.floats(-math.pi, math.pi)
quarter = math.pi / 2.0


@settings(max_examples=10)
@given(angles, angles, angles)
@example(1.0, quarter, 2.0)
@example(1.0, -quarter, 0.5)
@example(1.0, 0.0, 2.0)
@example(1.0, math.pi, 2.0)
def test_every_sequence_is_a_product_of_single_rotations(first, second, third):
    assert len(AXES) == 24
    for axes in AXES:
        singles = [
            rotation_matrix(angle, np.identity(3)["xyz".index(axis)])
            for angle, axis in zip((first, second, third), axes[1:], strict=True)
        ]
        one, two, three = singles if axes[0] == "r" else singles[::-1]
        expected = one @ two @ three
        assert euler_matrix(first, second, third, axes) == pytest.approx(expected, abs=1e-9)
        assert euler_matrix(*euler_from_matrix(expected, axes), axes) == pytest.approx(expected, abs=1e-6)


def test_numbers_of_the_documentation():
    assert quaternion_from_euler(1, 2, 3, "ryxz") == pytest.approx((0.310622, -0.718287, 0.444435, 0.435953), abs=1e-6)
    assert np.sum(euler_matrix(1, 2, 3, "syxz")[0]) == pytest.approx(-1.34786452)
    assert np.sum(euler_matrix(1, 2, 3, (0, 1, 0, 1))[0]) == pytest.approx(-0.383436184)
    assert euler_from_quaternion([0.06146124, 0, 0, 0.99810947]) == pytest.approx((0.123, 0, 0), abs=1e-6)
    assert quaternion_multiply([1, -2, 3, 4], [-5, 6, 7, 8]) == (-44, -14, 48, 28)
    turn = quaternion_from_matrix(rotation_matrix(0.123, (1, 2, 3)))
    assert turn == pytest.approx((0.0164262, 0.0328524, 0.0492786, 0.9981095), abs=1e-6)


def test_roll_pitch_and_yaw_are_the_default():
    assert quaternion_from_euler(0, 0, quarter) == pytest.approx((0, 0, math.sqrt(0.5), math.sqrt(0.5)))
    assert euler_from_quaternion(quaternion_from_euler(0.1, -0.2, 3.0)) == pytest.approx((0.1, -0.2, 3.0))


def test_a_sequence_that_is_none():
    with pytest.raises(ValueError, match="axes are `s` or `r` and three of x, y, z, as in 'sxyz', not 'xyz'"):
        quaternion_from_euler(0, 0, 0, "xyz")
    with pytest.raises(ValueError, match="an axis cannot follow itself, as in 'sxxz'"):
        euler_matrix(0, 0, 0, "sxxz")
