"""ResetLaunchConfigurations, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.actions.set_launch_configuration import ResetLaunchConfigurations as ResetLaunchConfigurations
