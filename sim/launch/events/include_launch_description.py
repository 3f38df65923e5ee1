"""IncludeLaunchDescription, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.events.execution_complete import IncludeLaunchDescription as IncludeLaunchDescription
