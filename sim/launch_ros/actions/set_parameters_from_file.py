"""SetParametersFromFile, in the module where launch_ros of ROS 2 has it."""

from launch_ros.actions.set_parameter import SetParametersFromFile as SetParametersFromFile
