"""PathSubstitution, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.substitutions.paths import PathSubstitution as PathSubstitution
