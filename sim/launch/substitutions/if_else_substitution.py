"""IfElseSubstitution, in the module where launch of ROS 2 has it."""

from launch.substitutions.boolean_substitution import IfElseSubstitution as IfElseSubstitution
