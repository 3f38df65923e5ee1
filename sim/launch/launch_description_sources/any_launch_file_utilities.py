"""The loader of launch files of any kind, which their file names determine."""

from __future__ import annotations

from pathlib import Path

from gz_course.sim.launch.invalid_launch_file_error import InvalidLaunchFileError
from gz_course.sim.launch.launch_description import LaunchDescription
from gz_course.sim.launch.launch_description_sources.python_launch_file_utilities import (
    get_launch_description_from_python_launch_file,
)

_OTHER_KINDS = {".xml": "an XML", ".yaml": "a YAML", ".yml": "a YAML"}


def get_launch_description_from_any_launch_file(launch_file_path: str) -> LaunchDescription:
    """Return the launch description of a file. Raises InvalidLaunchFileError for anything but a Python file."""
    kind = _OTHER_KINDS.get(Path(launch_file_path).suffix.lower())
    if kind is not None and Path(launch_file_path).is_file():
        raise InvalidLaunchFileError(
            f"'{launch_file_path}' is {kind} launch file; only Python launch files (.launch.py) can be used here"
        )
    return get_launch_description_from_python_launch_file(launch_file_path)
