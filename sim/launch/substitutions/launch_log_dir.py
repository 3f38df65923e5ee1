"""LaunchLogDir, in the module where launch of ROS 2 has it."""

from launch.substitutions.paths import LaunchLogDir as LaunchLogDir
