"""The import path of ROS 2 for the decorator `ready_to_test_action_timeout`."""

from gz_course.sim.ros.launch_testing.markers import ready_to_test_action_timeout

__all__ = ["ready_to_test_action_timeout"]
