"""matches_action, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.events.execution_complete import matches_action as matches_action
