"""PathJoinSubstitution, in the module where launch of ROS 2 has it."""

from launch.substitutions.paths import PathJoinSubstitution as PathJoinSubstitution
