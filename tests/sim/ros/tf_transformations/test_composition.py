"""Projections, shears, and matrices of several parts: what is read from them makes the same matrix again."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.sim.ros import tf_transformations as tf

seeds = st.integers(0, 2**32 - 1).map(np.random.default_rng)


@settings(max_examples=25)
@given(seeds)
def test_what_a_matrix_was_made_of(random):
    point, normal, direction, eye = (random.random(3) - 0.5 for _ in range(4))
    eye += 3.0 * normal
    for arguments in (
        {},
        {"direction": direction},
        {"perspective": eye},
        {"perspective": eye, "pseudo": True},
    ):
        made = tf.projection_matrix(point, normal, **arguments)
        found = tf.projection_from_matrix(made, pseudo=arguments.get("pseudo", False))
        assert tf.is_same_transform(made, tf.projection_matrix(*found))
        assert (found[2] is None, found[3] is None) == ("perspective" in arguments, "perspective" not in arguments)
        seen = made @ np.append(random.random(3), 1.0)
        if "pseudo" not in arguments:
            assert np.dot(seen[:3] / seen[3] - point, normal) == pytest.approx(0.0, abs=1e-6)

    across = np.cross(direction, normal)
    angle = random.random() + 0.3
    made = tf.shear_matrix(angle, direction, point, across)
    assert np.linalg.det(made) == pytest.approx(1.0)
    assert tf.shear_from_matrix(made)[0] == pytest.approx(angle)
    assert tf.is_same_transform(made, tf.shear_matrix(*tf.shear_from_matrix(made)))

    parts = [random.random(3) + 0.5, random.random(3) - 0.5, (random.random(3) - 0.5) * 3.0, random.random(3)]
    made = tf.compose_matrix(*parts)
    found = tf.decompose_matrix(made)
    for part, again in zip(parts, found, strict=False):
        assert again == pytest.approx(part)
    mirrored = made @ np.diag((-1.0, 1.0, 1.0, 1.0))
    assert tf.is_same_transform(mirrored, tf.compose_matrix(*tf.decompose_matrix(mirrored)))


@settings(max_examples=25)
@given(seeds)
def test_the_motion_between_two_sets_of_points(random):
    vectors = (random.random((4, 20)) - 0.5) * 20.0
    vectors[3] = 1.0
    motion = tf.concatenate_matrices(
        tf.translation_matrix(random.random(3)), tf.random_rotation_matrix(random.random(3)), tf.scale_matrix(2.0)
    )
    assert tf.superimposition_matrix(vectors, motion @ vectors, scaling=True) == pytest.approx(motion)
    mirrored = tf.superimposition_matrix(vectors, np.diag((-1.0, 1.0, 1.0, 1.0)) @ vectors)
    assert np.linalg.det(mirrored) == pytest.approx(1.0)


def test_clipping():
    box = tf.clip_matrix(1.0, 3.0, 2.0, 6.0, 0.5, 4.0)
    assert box @ (1.0, 2.0, 0.5, 1.0) == pytest.approx((-1, -1, -1, 1))
    assert box @ (3.0, 6.0, 4.0, 1.0) == pytest.approx((1, 1, 1, 1))
    view = tf.clip_matrix(1.0, 3.0, 2.0, 6.0, 0.5, 4.0, perspective=True)
    for corner, expected in (((1.0, 2.0), -1.0), ((3.0, 6.0), 1.0)):
        seen = view @ (*corner, 0.5, 1.0)
        assert seen[:3] / seen[3] == pytest.approx((expected, expected, -1.0))
    assert np.sum(tf.orthogonalization_matrix([9.8, 12.0, 15.5], [87.2, 80.7, 69.7])) == pytest.approx(43.063229)


def test_matrices_that_are_something_else():
    turn = tf.rotation_matrix(1.0, (1, 2, 3))
    for call in (tf.projection_from_matrix, tf.shear_from_matrix):
        with pytest.raises(ValueError, match="eigenvector"):
            call(turn)
    with pytest.raises(ValueError, match="the matrix is degenerate"):
        tf.decompose_matrix(tf.projection_matrix((0, 0, 0), (0, 0, 1)))
    with pytest.raises(ValueError, match="direction and normal vectors are not orthogonal"):
        tf.shear_matrix(1.0, (1, 0, 0), (0, 0, 0), (1, 1, 0))
    with pytest.raises(ValueError, match="wrong shape"):
        tf.superimposition_matrix(np.ones((3, 2)), np.ones((3, 2)))
    for bounds in ((1, 0, 0, 1, 1, 2), (0, 1, 0, 1, math.inf, 2)):
        with pytest.raises(ValueError, match="invalid frustum"):
            tf.clip_matrix(*bounds)


def test_a_ball_that_is_turned_with_the_mouse():
    turn = tf.quaternion_about_axis(1.0, (1, 2, 3))
    assert tf.is_same_transform(tf.Arcball(turn).matrix(), tf.quaternion_matrix(turn))
    ball = tf.Arcball(initial=tf.identity_matrix())
    ball.place([320, 320], 320)
    ball.down([500, 250])
    ball.drag([475, 275])
    assert np.sum(ball.matrix()) == pytest.approx(3.90583455)
    assert tf.is_same_transform(tf.Arcball().matrix(), tf.identity_matrix())
