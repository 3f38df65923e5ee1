"""PushEnvironment, in the module where launch of ROS 2 has it."""

from launch.actions.set_environment_variable import PushEnvironment as PushEnvironment
