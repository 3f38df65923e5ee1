"""ROS nodes in launch files: the interface of ROS 2's `launch_ros`, built on this project's `launch`.

Source: https://github.com/ros2/launch_ros
"""

from gz_course.sim.ros.launch_ros import actions, descriptions, parameter_descriptions, substitutions

__all__ = ["actions", "descriptions", "parameter_descriptions", "substitutions"]
