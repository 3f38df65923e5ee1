"""Matrices and what is read from them; quaternions as rotations."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.sim.ros import tf_transformations as tf

vectors = st.tuples(*[st.floats(-10.0, 10.0)] * 3).filter(lambda vector: math.hypot(*vector) > 0.1)
turns = st.integers(0, 2**32 - 1).map(lambda seed: tf.random_quaternion(np.random.default_rng(seed).random(3)))


@settings(max_examples=25)
@given(turns, turns, vectors)
def test_quaternions_turn_vectors_as_their_matrices_do(one, two, vector):
    both = tf.quaternion_multiply(one, two)
    assert tf.quaternion_matrix(both) == pytest.approx(tf.quaternion_matrix(one) @ tf.quaternion_matrix(two), abs=1e-9)
    sandwich = tf.quaternion_multiply(tf.quaternion_multiply(one, (*vector, 0.0)), tf.quaternion_conjugate(one))
    assert sandwich[:3] == pytest.approx(tf.quaternion_matrix(one)[:3, :3] @ vector, abs=1e-9)
    assert tf.quaternion_multiply(3.0 * one, tf.quaternion_inverse(3.0 * one)) == pytest.approx((0, 0, 0, 1), abs=1e-9)
    back = np.array(tf.quaternion_from_matrix(tf.quaternion_matrix(5.0 * one)))
    assert back[3] >= 0.0 and abs(np.dot(back, one)) == pytest.approx(1.0)


@settings(max_examples=25)
@given(turns, turns, st.floats(0.0, 1.0))
def test_slerp(one, two, share):
    found = tf.quaternion_slerp(one, two, share)
    whole = math.acos(min(1.0, abs(np.dot(one, two))))
    assert np.linalg.norm(found) == pytest.approx(1.0)
    assert abs(np.dot(one, found)) == pytest.approx(math.cos(share * whole), abs=1e-6)


@settings(max_examples=25)
@given(vectors, vectors, st.floats(0.01, 3.0))
def test_what_a_matrix_was_made_of(point, direction, number):
    moved = tf.concatenate_matrices(tf.translation_matrix(point), tf.rotation_matrix(number, direction))
    assert tf.translation_from_matrix(moved) == pytest.approx(point)
    assert moved @ tf.inverse_matrix(moved) == pytest.approx(tf.identity_matrix(), abs=1e-9)
    for made, again in (
        (tf.rotation_matrix(number, direction, point), lambda m: tf.rotation_matrix(*tf.rotation_from_matrix(m))),
        (tf.reflection_matrix(point, direction), lambda m: tf.reflection_matrix(*tf.reflection_from_matrix(m))),
        (tf.scale_matrix(-number, point), lambda m: tf.scale_matrix(*tf.scale_from_matrix(m))),
        (tf.scale_matrix(-number, point, direction), lambda m: tf.scale_matrix(*tf.scale_from_matrix(m))),
    ):
        assert tf.is_same_transform(made, again(made))
        assert not tf.is_same_transform(made, moved @ tf.scale_matrix(7.0))


def test_rotation_about_a_point():
    matrix = tf.rotation_matrix(math.pi / 2.0, (0, 0, 1), (1, 0, 0))
    assert matrix @ (2, 0, 0, 1) == pytest.approx((1, 1, 0, 1))
    assert matrix @ (1, 0, 5, 1) == pytest.approx((1, 0, 5, 1))


def test_rotation_is_found_behind_a_scaling():
    turn = tf.quaternion_about_axis(1.0, (1, 2, 3))
    assert tf.quaternion_from_matrix(tf.quaternion_matrix(turn) @ np.diag((2, 3, 4, 1))) == pytest.approx(turn)


def test_lengths_and_directions():
    many = np.random.default_rng(1).random((6, 5, 3))
    assert tf.vector_norm((3, 4)) == 5.0
    assert tf.vector_norm([]) == 0.0
    assert tf.vector_norm(many, axis=-1) == pytest.approx(np.linalg.norm(many, axis=-1))
    assert np.linalg.norm(tf.unit_vector(many, axis=1), axis=1) == pytest.approx(np.ones((6, 3)))
    out = np.empty_like(many)
    assert tf.unit_vector(many, axis=2, out=out) is None
    assert np.linalg.norm(out, axis=2) == pytest.approx(np.ones((6, 5)))


def test_a_matrix_that_is_no_reflection():
    with pytest.raises(ValueError, match="no unit eigenvector corresponding to eigenvalue -1"):
        tf.reflection_from_matrix(tf.identity_matrix())
