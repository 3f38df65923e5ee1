"""EqualsSubstitution, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.substitutions.boolean_substitution import EqualsSubstitution as EqualsSubstitution
