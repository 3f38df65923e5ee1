"""Launch files in XML and YAML: the parts that both have in common, with the names of ROS 2's `launch.frontend`.

A file becomes an `Entity` (`launch_xml`, `launch_yaml`), and the `Parser` makes actions of it. Actions and
substitutions are made known with `expose_action` and `expose_substitution`.

Source: https://github.com/ros2/launch/tree/jazzy/launch/launch/frontend
"""

from gz_course.sim.ros.launch.frontend.entity import Entity
from gz_course.sim.ros.launch.frontend.expose import expose_action, expose_substitution
from gz_course.sim.ros.launch.frontend.parse_substitution import parse_if_substitutions, parse_substitution
from gz_course.sim.ros.launch.frontend.parser import InvalidFrontendLaunchFileError, Parser

__all__ = [
    "Entity",
    "InvalidFrontendLaunchFileError",
    "Parser",
    "expose_action",
    "expose_substitution",
    "parse_if_substitutions",
    "parse_substitution",
]
