"""Actions for ROS: nodes, and what holds for all nodes of a scope."""

from gz_course.sim.launch_ros.actions.composable_node_container import (
    ComposableNodeContainer,
    LifecycleNode,
    LoadComposableNodes,
)
from gz_course.sim.launch_ros.actions.node import Node
from gz_course.sim.launch_ros.actions.push_ros_namespace import PushROSNamespace, PushRosNamespace
from gz_course.sim.launch_ros.actions.set_parameter import SetParameter, SetParametersFromFile, SetUseSimTime
from gz_course.sim.launch_ros.actions.set_remap import SetRemap

__all__ = [
    "ComposableNodeContainer",
    "LifecycleNode",
    "LoadComposableNodes",
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "SetParameter",
    "SetParametersFromFile",
    "SetRemap",
    "SetUseSimTime",
]
