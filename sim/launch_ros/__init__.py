"""ROS nodes in launch files: the interface of ROS 2's `launch_ros`, built on the `launch` beside it."""

from gz_course.sim.launch_ros import actions, descriptions, parameter_descriptions, substitutions

__all__ = ["actions", "descriptions", "parameter_descriptions", "substitutions"]
