"""UnsetLaunchConfiguration, in the module where launch of ROS 2 has it."""

from launch.actions.set_launch_configuration import UnsetLaunchConfiguration as UnsetLaunchConfiguration
