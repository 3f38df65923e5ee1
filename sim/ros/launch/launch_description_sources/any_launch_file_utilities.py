"""The loader of launch files of any kind, which their file names determine, or else their first lines."""

from __future__ import annotations

import re
from pathlib import Path

from gz_course.sim.ros.launch.launch_description import LaunchDescription
from gz_course.sim.ros.launch.launch_description_sources.frontend_launch_file_utilities import (
    get_launch_description_from_frontend_launch_file,
)
from gz_course.sim.ros.launch.launch_description_sources.python_launch_file_utilities import (
    get_launch_description_from_python_launch_file,
)

_YAML = re.compile(rb"(\s*(#[^\n]*|---[^\n]*|%[^\n]*)\n|\s)*launch\s*:")


def get_launch_description_from_any_launch_file(launch_file_path: str) -> LaunchDescription:
    """Return the launch description of a file in Python, XML or YAML. Raises InvalidLaunchFileError."""
    extension = Path(launch_file_path).suffix.lower()
    if extension in (".xml", ".yaml", ".yml") or (extension != ".py" and _is_markup(Path(launch_file_path))):
        return get_launch_description_from_frontend_launch_file(launch_file_path)
    return get_launch_description_from_python_launch_file(launch_file_path)


def _is_markup(path: Path) -> bool:
    """Return whether a file of another name, such as `robot.launch`, begins like XML or YAML."""
    try:
        with path.open("rb") as file:
            start = file.read(4096)
    except (OSError, ValueError):
        return False
    return start.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<") or _YAML.match(start) is not None
