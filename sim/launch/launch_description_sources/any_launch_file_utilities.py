"""get_launch_description_from_any_launch_file, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.launch_description_sources.any_launch_description_source import (
    get_launch_description_from_any_launch_file as get_launch_description_from_any_launch_file,
)
