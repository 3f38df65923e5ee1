"""FileContent, in the module where launch of ROS 2 has it."""

from launch.substitutions.paths import FileContent as FileContent
