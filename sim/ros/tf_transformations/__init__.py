"""Quaternions (x, y, z, w), Euler angles and homogeneous matrices, in place of the `tf_transformations` package.

Of its names only `Arcball` and the functions for it are missing.

Source: https://github.com/DLu/tf_transformations
"""

from gz_course.sim.ros.tf_transformations.composition import (
    compose_matrix,
    decompose_matrix,
    orthogonalization_matrix,
    shear_from_matrix,
    shear_matrix,
    superimposition_matrix,
)
from gz_course.sim.ros.tf_transformations.euler_angles import (
    euler_from_matrix,
    euler_from_quaternion,
    euler_matrix,
    quaternion_from_euler,
)
from gz_course.sim.ros.tf_transformations.matrices import (
    concatenate_matrices,
    identity_matrix,
    inverse_matrix,
    is_same_transform,
    quaternion_from_matrix,
    quaternion_matrix,
    random_rotation_matrix,
    reflection_from_matrix,
    reflection_matrix,
    rotation_from_matrix,
    rotation_matrix,
    scale_from_matrix,
    scale_matrix,
    translation_from_matrix,
    translation_matrix,
)
from gz_course.sim.ros.tf_transformations.projections import clip_matrix, projection_from_matrix, projection_matrix
from gz_course.sim.ros.tf_transformations.quaternions import (
    quaternion_about_axis,
    quaternion_conjugate,
    quaternion_inverse,
    quaternion_multiply,
    quaternion_slerp,
    random_quaternion,
)
from gz_course.sim.ros.tf_transformations.vectors import random_vector, unit_vector, vector_norm

__all__ = [
    "clip_matrix",
    "compose_matrix",
    "concatenate_matrices",
    "decompose_matrix",
    "euler_from_matrix",
    "euler_from_quaternion",
    "euler_matrix",
    "identity_matrix",
    "inverse_matrix",
    "is_same_transform",
    "orthogonalization_matrix",
    "projection_from_matrix",
    "projection_matrix",
    "quaternion_about_axis",
    "quaternion_conjugate",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_inverse",
    "quaternion_matrix",
    "quaternion_multiply",
    "quaternion_slerp",
    "random_quaternion",
    "random_rotation_matrix",
    "random_vector",
    "reflection_from_matrix",
    "reflection_matrix",
    "rotation_from_matrix",
    "rotation_matrix",
    "scale_from_matrix",
    "scale_matrix",
    "shear_from_matrix",
    "shear_matrix",
    "superimposition_matrix",
    "translation_from_matrix",
    "translation_matrix",
    "unit_vector",
    "vector_norm",
]
