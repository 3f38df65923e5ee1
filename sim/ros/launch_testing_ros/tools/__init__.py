"""Compares the output of ROS nodes with what is expected."""

from gz_course.sim.ros.launch_testing_ros.tools.output import basic_output_filter, get_rmw_output_filter

__all__ = ["basic_output_filter", "get_rmw_output_filter"]
