"""The source for launch files of any kind."""

from __future__ import annotations

import os

from gz_course.sim.ros.launch.launch_description import LaunchDescription
from gz_course.sim.ros.launch.launch_description_source import LaunchDescriptionSource
from gz_course.sim.ros.launch.launch_description_sources.any_launch_file_utilities import (
    get_launch_description_from_any_launch_file,
)
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """The launch file at a path, which may contain substitutions."""

    def __init__(self, launch_file_path: SomeSubstitutionsType | os.PathLike[str]) -> None:
        super().__init__(location=launch_file_path, method="any launch file")

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return get_launch_description_from_any_launch_file(location)
