"""NotEqualsSubstitution, in the module where launch of ROS 2 has it."""

from launch.substitutions.boolean_substitution import NotEqualsSubstitution as NotEqualsSubstitution
