"""SetParametersFromFile, in the module where launch_ros of ROS 2 has it."""

from gz_course.sim.launch_ros.actions.set_parameter import SetParametersFromFile as SetParametersFromFile
