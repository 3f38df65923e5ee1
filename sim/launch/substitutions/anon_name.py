"""AnonName, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.substitutions.this_launch_file import AnonName as AnonName
