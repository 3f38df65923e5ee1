"""LifecycleNode, in the module where launch_ros of ROS 2 has it."""

from gz_course.sim.launch_ros.actions.composable_node_container import LifecycleNode as LifecycleNode
