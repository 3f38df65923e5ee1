"""The source for launch files in XML and YAML."""

from __future__ import annotations

import os

from gz_course.sim.ros.launch.frontend.parser import Parser
from gz_course.sim.ros.launch.launch_description import LaunchDescription
from gz_course.sim.ros.launch.launch_description_source import LaunchDescriptionSource
from gz_course.sim.ros.launch.launch_description_sources.frontend_launch_file_utilities import (
    get_launch_description_from_frontend_launch_file,
)
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType


class FrontendLaunchDescriptionSource(LaunchDescriptionSource):
    """The launch file in XML or YAML at a path, which may contain substitutions; without a parser its name decides."""

    def __init__(
        self, launch_file_path: SomeSubstitutionsType | os.PathLike[str], *, parser: Parser | None = None
    ) -> None:
        super().__init__(location=launch_file_path, method="interpreted frontend launch file")
        self._parser = parser

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return get_launch_description_from_frontend_launch_file(location, parser=self._parser)
