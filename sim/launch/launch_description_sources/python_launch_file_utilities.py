"""What loads Python launch files, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.launch_description_sources.python_launch_description_source import (
    InvalidPythonLaunchFileError,
    get_launch_description_from_python_launch_file,
    load_python_launch_file_as_module,
)

__all__ = [
    "InvalidPythonLaunchFileError",
    "get_launch_description_from_python_launch_file",
    "load_python_launch_file_as_module",
]
