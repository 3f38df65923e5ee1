"""LaunchConfigurationNotEquals, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.conditions.launch_configuration_equals import (
    LaunchConfigurationNotEquals as LaunchConfigurationNotEquals,
)
