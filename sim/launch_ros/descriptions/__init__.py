"""Descriptions of parameters and of composable nodes."""

from launch_ros.descriptions.composable_node import ComposableLifecycleNode, ComposableNode
from launch_ros.parameter_descriptions import Parameter, ParameterFile, ParameterValue

__all__ = ["ComposableLifecycleNode", "ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]
