"""Launch files in XML, with the names of ROS 2's `launch_xml`.

Source: https://github.com/ros2/launch/tree/jazzy/launch_xml
"""

from gz_course.sim.ros.launch_xml import launch_description_sources
from gz_course.sim.ros.launch_xml.entity import Entity
from gz_course.sim.ros.launch_xml.parser import Parser

__all__ = ["Entity", "Parser", "launch_description_sources"]
