"""Conversions between users' arguments, substitutions and text, with the names of ROS 2's launch."""

from gz_course.sim.ros.launch.utilities.class_tools_impl import is_a, is_a_subclass
from gz_course.sim.ros.launch.utilities.create_futures_impl import create_future
from gz_course.sim.ros.launch.utilities.describe_substitutions_impl import describe_substitutions
from gz_course.sim.ros.launch.utilities.ensure_argument_type_impl import ensure_argument_type
from gz_course.sim.ros.launch.utilities.normalize_to_list_of_substitutions_impl import (
    normalize_to_list_of_substitutions,
)
from gz_course.sim.ros.launch.utilities.perform_substitutions_impl import perform_substitutions

__all__ = [
    "create_future",
    "describe_substitutions",
    "ensure_argument_type",
    "is_a",
    "is_a_subclass",
    "normalize_to_list_of_substitutions",
    "perform_substitutions",
]
