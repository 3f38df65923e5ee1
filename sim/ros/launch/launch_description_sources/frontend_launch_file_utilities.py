"""The loader of launch files in XML and YAML."""

from __future__ import annotations

from pathlib import Path

from gz_course.sim.ros.launch.frontend.parser import InvalidFrontendLaunchFileError, Parser
from gz_course.sim.ros.launch.launch_description import LaunchDescription
from gz_course.sim.ros.launch.launch_description_sources.python_launch_file_utilities import why_not_readable


def get_launch_description_from_frontend_launch_file(
    launch_file_path: str, *, parser: Parser | type[Parser] | None = None
) -> LaunchDescription:
    """Return the launch description of a file in XML or YAML. Raises InvalidLaunchFileError with line and column."""
    path = Path(launch_file_path)
    try:
        path.open("rb").close()
    except (OSError, ValueError) as error:
        raise InvalidFrontendLaunchFileError(why_not_readable(path, error)) from None
    root, own_parser = (parser or Parser).load(launch_file_path)
    description: LaunchDescription = own_parser.parse_description(root)
    return description
