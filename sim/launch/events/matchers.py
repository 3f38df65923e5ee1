"""matches_action, in the module where launch of ROS 2 has it."""

from launch.events.execution_complete import matches_action as matches_action
