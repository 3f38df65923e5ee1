"""Quaternions (x, y, z, w), Euler angles and homogeneous matrices, in place of the `tf_transformations` package.

Of its names these are missing: `projection_matrix`, `clip_matrix`, `shear_matrix`, their counterparts from a matrix,
`compose_matrix`, `decompose_matrix`, `orthogonalization_matrix`, `superimposition_matrix` and `Arcball`.

Source: https://github.com/DLu/tf_transformations
"""

from gz_course.sim.tf_transformations.euler_angles import (
    euler_from_matrix,
    euler_from_quaternion,
    euler_matrix,
    quaternion_from_euler,
)
from gz_course.sim.tf_transformations.matrices import (
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
from gz_course.sim.tf_transformations.quaternions import (
    quaternion_about_axis,
    quaternion_conjugate,
    quaternion_inverse,
    quaternion_multiply,
    quaternion_slerp,
    random_quaternion,
)
from gz_course.sim.tf_transformations.vectors import random_vector, unit_vector, vector_norm

__all__ = [
    "concatenate_matrices",
    "euler_from_matrix",
    "euler_from_quaternion",
    "euler_matrix",
    "identity_matrix",
    "inverse_matrix",
    "is_same_transform",
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
    "translation_from_matrix",
    "translation_matrix",
    "unit_vector",
    "vector_norm",
]
