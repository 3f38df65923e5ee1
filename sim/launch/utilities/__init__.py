"""Turns what users write into substitutions, and those into text; under the names of ROS 2's launch."""

from gz_course.sim.launch.substitution import normalize_to_list_of_substitutions, perform_substitutions

__all__ = ["normalize_to_list_of_substitutions", "perform_substitutions"]
