"""Descriptions of parameters and of composable nodes."""

from gz_course.sim.ros.launch_ros.descriptions.composable_lifecycle_node import ComposableLifecycleNode
from gz_course.sim.ros.launch_ros.descriptions.composable_node import ComposableNode
from gz_course.sim.ros.launch_ros.parameter_descriptions import Parameter, ParameterFile, ParameterValue

__all__ = ["ComposableLifecycleNode", "ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]
