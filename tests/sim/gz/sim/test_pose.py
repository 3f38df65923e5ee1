"""Poses: composition, inverse, roll-pitch-yaw, against MuJoCo's own quaternion routines."""

from __future__ import annotations

import math

import mujoco
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.pose import Pose, matrix, multiply, quaternion_between, quaternion_from_rpy, rotate

angles = st.floats(-math.pi, math.pi)
lengths = st.floats(-100.0, 100.0)
poses = st.builds(Pose.from_rpy, st.tuples(lengths, lengths, lengths), st.tuples(angles, angles, angles))
vectors = st.tuples(lengths, lengths, lengths)


@given(poses)
def test_a_pose_times_its_inverse_is_the_identity(pose: Pose) -> None:
    assert (pose * pose.inverse()).is_close(Pose(), 1e-9)


@given(poses, poses, vectors)
def test_chaining_poses_is_applying_one_after_the_other(a: Pose, b: Pose, point: tuple[float, ...]) -> None:
    assert np.allclose((a * b).transform(point), a.transform(b.transform(point)), atol=1e-9)


@given(poses, poses)
def test_multiplication_and_rotation_agree_with_mujoco(a: Pose, b: Pose) -> None:
    product, turned, rotation = np.zeros(4), np.zeros(3), np.zeros(9)
    mujoco.mju_mulQuat(product, a.quaternion, b.quaternion)
    mujoco.mju_rotVecQuat(turned, b.position, a.quaternion)
    mujoco.mju_quat2Mat(rotation, a.quaternion)
    assert np.allclose(multiply(a.quaternion, b.quaternion), product, atol=1e-12)
    assert np.allclose(rotate(a.quaternion, b.position), turned, atol=1e-9)
    assert np.allclose(matrix(a.quaternion).ravel(), rotation, atol=1e-12)


@given(angles, st.floats(-1.5, 1.5), angles)
def test_roll_pitch_yaw_survive_the_way_there_and_back(roll: float, pitch: float, yaw: float) -> None:
    back = Pose((0, 0, 0), quaternion_from_rpy(roll, pitch, yaw)).rpy()
    assert np.allclose(np.cos(np.subtract(back, (roll, pitch, yaw))), 1.0, atol=1e-9)


def test_rotation_is_about_fixed_axes_roll_first() -> None:
    pose = Pose.from_rpy((0, 0, 0), (math.pi / 2, 0, math.pi / 2))
    assert np.allclose(pose.transform((0, 1, 0)), (0, 0, 1), atol=1e-12)
    assert np.allclose(pose.transform((1, 0, 0)), (0, 1, 0), atol=1e-12)


@given(vectors.filter(lambda v: max(map(abs, v)) > 1e-3), vectors.filter(lambda v: max(map(abs, v)) > 1e-3))
def test_quaternion_between_turns_one_direction_into_the_other(a: tuple[float, ...], b: tuple[float, ...]) -> None:
    turned = rotate(quaternion_between(a, b), np.array(a) / np.linalg.norm(a))
    assert np.allclose(turned, np.array(b) / np.linalg.norm(b), atol=1e-5)
