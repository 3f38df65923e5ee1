"""Conversions between users' arguments, substitutions and text, with the names of ROS 2's launch."""

from gz_course.sim.launch.utilities.describe_substitutions_impl import describe_substitutions
from gz_course.sim.launch.utilities.normalize_to_list_of_substitutions_impl import normalize_to_list_of_substitutions
from gz_course.sim.launch.utilities.perform_substitutions_impl import perform_substitutions

__all__ = ["describe_substitutions", "normalize_to_list_of_substitutions", "perform_substitutions"]
