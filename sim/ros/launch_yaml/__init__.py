"""Launch files in YAML, with the names of ROS 2's `launch_yaml`.

Source: https://github.com/ros2/launch/tree/jazzy/launch_yaml
"""

from gz_course.sim.ros.launch_yaml import launch_description_sources
from gz_course.sim.ros.launch_yaml.entity import Entity
from gz_course.sim.ros.launch_yaml.parser import Parser

__all__ = ["Entity", "Parser", "launch_description_sources"]
