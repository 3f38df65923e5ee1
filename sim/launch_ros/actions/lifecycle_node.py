"""LifecycleNode, in the module where launch_ros of ROS 2 has it."""

from launch_ros.actions.composable_node_container import LifecycleNode as LifecycleNode
