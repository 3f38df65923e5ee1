"""Substitutions that write a changed copy of a file, or ask what a parameter file has."""

from gz_course.sim.ros.nav2_common.launch.has_node_params import HasNodeParams
from gz_course.sim.ros.nav2_common.launch.parse_multirobot_pose import ParseMultiRobotPose
from gz_course.sim.ros.nav2_common.launch.replace_string import ReplaceString
from gz_course.sim.ros.nav2_common.launch.rewritten_yaml import RewrittenYaml

__all__ = ["HasNodeParams", "ParseMultiRobotPose", "ReplaceString", "RewrittenYaml"]
