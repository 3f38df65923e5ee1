"""ResetEnvironment, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.actions.set_environment_variable import ResetEnvironment as ResetEnvironment
