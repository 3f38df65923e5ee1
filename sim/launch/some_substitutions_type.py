"""SomeSubstitutionsType, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.substitution import SomeSubstitutionsType, SomeSubstitutionsType_types_tuple

__all__ = ["SomeSubstitutionsType", "SomeSubstitutionsType_types_tuple"]
