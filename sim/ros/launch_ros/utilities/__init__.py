"""Namespaces, remappings and parameters of nodes, for actions of one's own, with the names of ROS 2's launch_ros."""

from gz_course.sim.ros.launch_ros.utilities.evaluate_parameters import evaluate_parameters
from gz_course.sim.ros.launch_ros.utilities.namespace_utils import (
    is_namespace_absolute,
    is_root_namespace,
    make_namespace_absolute,
    prefix_namespace,
)
from gz_course.sim.ros.launch_ros.utilities.normalize_parameters import normalize_parameters
from gz_course.sim.ros.launch_ros.utilities.normalize_remap_rule import normalize_remap_rule, normalize_remap_rules

__all__ = [
    "evaluate_parameters",
    "is_namespace_absolute",
    "is_root_namespace",
    "make_namespace_absolute",
    "normalize_parameters",
    "normalize_remap_rule",
    "normalize_remap_rules",
    "prefix_namespace",
]
